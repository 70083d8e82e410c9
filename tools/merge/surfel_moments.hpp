// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tools/merge/prepared_submap.hpp"

namespace mapweld::merge {

// First and second moments of points, to be added up over neighbouring voxels. Double, since second moments of points
// 50 m away cancel.
struct SurfelMoments {
  double n = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void Add(const Eigen::Vector3f& point);
  void Add(const SurfelMoments& other);
  // Writes the inverse covariance and is_structure; leaves the mean.
  void Describe(Surfel* surfel) const;
};

}  // namespace mapweld::merge
