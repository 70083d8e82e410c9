// SPDX-License-Identifier: Apache-2.0
// A pose graph of a city: drives through a street grid, drifting odometry, loops where they meet.
#pragma once

#include <vector>

#include "tools/pose_graph/pose_graph.hpp"

namespace mapweld::bench {

struct CityConfig {
  int drives = 50;
  int poses = 480;  // per drive, 5 m apart
  int blocks = 60;  // the city is a square of so many blocks of 100 m
  unsigned seed = 1;
};

struct CityGraph {
  pose_graph::PoseGraph graph;  // starts at the odometry from a guess of 1 m and 0.01 rad; held: the first pose
  std::vector<geom::Pose3> truth;
  std::vector<int> drive_of;
  int loops = 0;
};

// 0.03 m and 0.0015 rad of noise per 5 m of odometry, 0.1 m and 0.01 rad per loop; a loop where poses of two drives, or
// of one that comes back, lie within 4 m, with probability 0.4. With 50 drives about 1 100 loops.
CityGraph MakeCity(const CityConfig& config);

}  // namespace mapweld::bench
