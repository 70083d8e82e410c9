// SPDX-License-Identifier: Apache-2.0
// The LiDAR half of the filter: how well a scan fits the planes of the map, linearised.
#pragma once

#include <span>

#include "core/base/fixed_vector.hpp"
#include "core/geom/pose3.hpp"
#include "core/lio/degeneracy.hpp"
#include "core/lio/voxel_map.hpp"
#include "core/scan/voxel_downsample.hpp"

namespace mapweld::lio {

struct ScanMatchConfig {
  double range_sigma_m = 0.03;  // of a LiDAR point across a plane
  double correlation = 12.0;    // neighbouring points share their errors: this many count as one
  double gate_sigma = 4.0;      // residuals beyond it are ignored ...
  double min_gate_m = 0.15;     // ... but never below this distance
};

// sum J'WJ, sum J'Wr of the point-to-plane residuals with J against (position in odom, right rotation error).
struct ScanMatch {
  geom::Mat6d information = geom::Mat6d::Zero();
  geom::Vec6d gradient = geom::Vec6d::Zero();
  NormalNoise normal_noise;
  int matched = 0;
  int inliers = 0;
  double residual_sq_sum = 0;  // m^2 over the inliers
};

// The plane of the map that each feature of a scan lies on.
class FeaturePlanes {
 public:
  // A look-up of 4 voxels for each feature at the given pose.
  void Find(const scan::FeaturePoints& features, const geom::Pose3& odom_T_body, VoxelMap* map);
  // Does a pose this far from that of Find still go with the same planes? Within 5 cm at the sensor and at 25 m.
  [[nodiscard]] bool HoldAt(const geom::Pose3& odom_T_body) const;
  // Parallel to the features. A variance below 0: none.
  [[nodiscard]] std::span<const Plane> planes() const { return planes_.span(); }

 private:
  geom::Pose3 found_at_;
  FixedVector<Plane, kCap.scan_features> planes_;
};

// One pass over the features, about 80 flops each. gate_m widens the gate in the first iterations. Residual:
// n . (odom_T_body p - mean), weight Huber / (variance * correlation).
ScanMatch MatchScan(const scan::FeaturePoints& features, const FeaturePlanes& planes, const geom::Pose3& odom_T_body,
                    double gate_m, const ScanMatchConfig& config);

}  // namespace mapweld::lio
