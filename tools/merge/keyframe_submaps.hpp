// SPDX-License-Identifier: Apache-2.0
// Submaps and descriptions of neighbouring keyframes of one recording.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "core/place/describer.hpp"
#include "tools/merge/recording.hpp"
#include "tools/merge/voxel_mean.hpp"

namespace mapweld::merge {

// Keeps the scans that the last keyframe needed, since the next one needs most of them again. One per thread. A submap
// depends only on the recording and the keyframe, not on what was built before.
class SubmapBuilder {
 public:
  SubmapBuilder(const Recording& recording, const RecordingConfig& config, const std::vector<geom::Pose3>& odom_T_scan,
                const std::vector<double>& scan_path_m);

  // A keyframe with too few points for a description keeps a description of scale 0, which matches nothing.
  void Build(int keyframe_scan, int keyframe, SubmapCloud* cloud, place::PlaceDescription* place);

 private:
  const std::vector<WeightedPoint>& Scan(int scan);
  bool Used(int scan) const;

  const Recording* recording_;
  RecordingConfig config_;
  const std::vector<geom::Pose3>* odom_T_scan_;
  const std::vector<double>* scan_path_m_;
  std::map<int, std::vector<WeightedPoint>> scans_;  // by index, thinned, lidar frame
  VoxelMean scan_voxels_;
  VoxelMean submap_voxels_;
  std::vector<WeightedPoint> points_;
  std::unique_ptr<place::Describer> describer_;
  std::unique_ptr<submap::Submap> submap_;
};

}  // namespace mapweld::merge
