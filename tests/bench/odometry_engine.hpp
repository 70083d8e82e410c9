// SPDX-License-Identifier: Apache-2.0
// What the comparison of odometries asks of each of them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/geom/pose3.hpp"

namespace mapweld::bench {

class OdometryEngine {
 public:
  virtual ~OdometryEngine() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  // Takes the next scan (p_lidar, m, without motion distortion) and gives world_T_lidar, world being the first scan.
  virtual geom::Pose3 Register(const std::vector<Eigen::Vector3f>& points) = 0;
};

std::unique_ptr<OdometryEngine> MakeKissIcp();
std::unique_ptr<OdometryEngine> MakeSmallGicp();
std::unique_ptr<OdometryEngine> MakePclGicp();

}  // namespace mapweld::bench
