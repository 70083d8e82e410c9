// SPDX-License-Identifier: Apache-2.0
// Do two drives make the same submaps of the same places? Submaps are laid over each other by the truth, so what
// differs is what was seen, not where the odometry thought it was.
#pragma once

#include <string>
#include <vector>

#include "core/geom/pose3.hpp"
#include "tools/io/tum.hpp"
#include "tools/odometry/odometry_run.hpp"

namespace mapweld::odometry {

struct PlacedSubmap {
  geom::Pose3 world_T_level;
  std::vector<Eigen::Vector3f> points;  // in `level`
};

// The submaps of a run that were released in full (not flushed at the end of the drive) and have truth at their time.
std::vector<PlacedSubmap> PlaceSubmaps(const OdometryRun& run, const std::vector<io::StampedPose>& world_T_body);

struct Agreement {
  std::size_t pairs = 0;  // of submaps
  // Means over the pairs, of the points within 45 m of both keyframes. A point is shared when the other submap has one
  // within 0.5 m, the edge of a voxel.
  double a_in_b = 0;
  double b_in_a = 0;
  // Share of the voxels of a world grid of 0.5 m occupied by either that both occupy: neighbours do not count, so even
  // two submaps of the same walls differ where a wall lies on a voxel's face.
  double same_voxel = 0;
};

// Each submap of a against the nearest of b within kPairApart_m: those driven the same way and the opposite way.
struct BothWays {
  Agreement same_way;
  Agreement opposite;
};
inline constexpr double kPairApart_m = 4.0;  // half a street, as the two directions use two lanes
BothWays CompareSubmaps(const std::vector<PlacedSubmap>& a, const std::vector<PlacedSubmap>& b);

std::string Report(const BothWays& agreement);

}  // namespace mapweld::odometry
