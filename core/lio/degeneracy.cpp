// SPDX-License-Identifier: Apache-2.0
#include "core/lio/degeneracy.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace mapweld::lio {
namespace {

// Projector onto the directions of a block that are determined.
geom::Mat3d Determined(const geom::Mat3d& block, double min_information, const geom::Mat3d& noise, double* smallest,
                       int* open) {
  Eigen::SelfAdjointEigenSolver<geom::Mat3d> solver;
  solver.computeDirect(block);
  *smallest = solver.eigenvalues()(0);
  *open = 0;
  geom::Mat3d projector = geom::Mat3d::Identity();
  for (int i = 0; i < 3; ++i) {
    const geom::Vec3d direction = solver.eigenvectors().col(i);
    if (solver.eigenvalues()(i) >= std::max(min_information, direction.dot(noise * direction))) continue;
    projector -= direction * direction.transpose();
    ++*open;
  }
  return projector;
}

}  // namespace

Degeneracy RemoveOpenDirections(const DegeneracyConfig& config, const NormalNoise& noise, geom::Mat6d* information,
                                geom::Vec6d* gradient) {
  Degeneracy result;
  geom::Mat6d projector = geom::Mat6d::Zero();
  projector.topLeftCorner<3, 3>() = Determined(information->topLeftCorner<3, 3>(), config.min_position_information,
                                               config.min_over_noise * noise.position * geom::Mat3d::Identity(),
                                               &result.position_information, &result.open_positions);
  projector.bottomRightCorner<3, 3>() =
      Determined(information->bottomRightCorner<3, 3>(), config.min_rotation_information,
                 config.min_over_noise * noise.rotation, &result.rotation_information, &result.open_rotations);
  if (!result.any()) return result;
  *information = projector * (*information) * projector;
  *gradient = projector * (*gradient);
  return result;
}

}  // namespace mapweld::lio
