// SPDX-License-Identifier: Apache-2.0
#include "tools/baselines/m2dp.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/place/normalize.hpp"
#include "tools/describe/cosine.hpp"

namespace mapweld::baselines {
namespace {

using Cloud = Eigen::Matrix3Xf;
constexpr float kPi = std::numbers::pi_v<float>;

// Rows of the cloud turned into its principal axes, the longest first. The sign of the first two axes is free: the side
// with the larger sum of cubes is positive, which does not depend on how the cloud lay. The third completes them.
Cloud InPrincipalAxes(Cloud cloud) {
  cloud.colwise() -= cloud.rowwise().mean().eval();
  const Eigen::Matrix3f scatter = cloud * cloud.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver(scatter);
  Eigen::Matrix3f axes;
  for (int i = 0; i < 2; ++i) {
    Eigen::Vector3f axis = solver.eigenvectors().col(2 - i);
    if ((axis.transpose() * cloud).array().cube().sum() < 0) axis = -axis;
    axes.row(i) = axis;
  }
  axes.row(2) = axes.row(0).cross(axes.row(1));
  return axes * cloud;
}

// Share of the points in each circle (radii grow with the square, the last takes all beyond) and sector.
Eigen::RowVectorXf PlaneDensity(const Cloud& cloud, const Eigen::Vector3f& normal, float reach) {
  const Eigen::Vector3f x_axis = (Eigen::Vector3f::UnitX() - normal.x() * normal).stableNormalized();
  const Eigen::Vector3f y_axis = normal.cross(x_axis);
  Eigen::RowVectorXf density = Eigen::RowVectorXf::Zero(M2dp::kBins);
  for (Eigen::Index i = 0; i < cloud.cols(); ++i) {
    const float x = x_axis.dot(cloud.col(i));
    const float y = y_axis.dot(cloud.col(i));
    const float circle = std::sqrt(std::hypot(x, y) / reach) * static_cast<float>(M2dp::kCircles);
    const float sector = (std::atan2(y, x) / (2 * kPi) + 0.5F) * static_cast<float>(M2dp::kSectors);
    const auto c = std::min(static_cast<std::size_t>(circle), M2dp::kCircles - 1);
    const auto s = std::min(static_cast<std::size_t>(sector), M2dp::kSectors - 1);
    density(static_cast<Eigen::Index>(c * M2dp::kSectors + s)) += 1;
  }
  return density / static_cast<float>(cloud.cols());
}

}  // namespace

Status M2dp::Describe(const submap::Submap& submap, place::PlaceDescription* place) {
  if (submap.points.size() < kMinPoints) return Status::kBadInput;
  Cloud cloud(3, static_cast<Eigen::Index>(submap.points.size()));
  for (std::size_t i = 0; i < submap.points.size(); ++i) {
    const submap::SubmapPoint& p = submap.points[i];
    cloud.col(static_cast<Eigen::Index>(i)) = Eigen::Vector3f(p.x, p.y, p.z);
  }
  if (!cloud.allFinite()) return Status::kBadInput;
  cloud = InPrincipalAxes(std::move(cloud));
  const float reach = cloud.colwise().norm().maxCoeff();
  if (reach <= 0) return Status::kBadInput;
  Eigen::MatrixXf densities(kPlanes, kBins);
  for (std::size_t p = 0; p < kAzimuths; ++p) {
    for (std::size_t q = 0; q < kElevations; ++q) {
      const float azimuth = kPi * (static_cast<float>(p) / (kAzimuths - 1) - 0.5F);
      const float elevation = kPi / 2 * static_cast<float>(q) / (kElevations - 1);
      const Eigen::Vector3f normal(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                   std::sin(elevation));
      densities.row(static_cast<Eigen::Index>(p * kElevations + q)) = PlaneDensity(cloud, normal, reach);
    }
  }
  const Eigen::JacobiSVD<Eigen::MatrixXf> svd(densities, Eigen::ComputeThinU | Eigen::ComputeThinV);
  // Of a matrix without negative elements they have one sign each, which is free.
  std::array<float, place::kDescriptorDim> values{};
  Eigen::Map<Eigen::Matrix<float, kSize, 1>>(values.data()) << svd.matrixU().col(0).cwiseAbs(),
      svd.matrixV().col(0).cwiseAbs();
  *place = {};
  place->descriptor.scale = place::QuantizeToInt8(values, &place->descriptor.q);
  return Status::kOk;
}

describe::PlaceMethod::Features M2dp::Prepare(const place::PlaceDescription& place) const {
  return describe::UnitFeatures(place.descriptor, kSize);
}

float M2dp::Distance(const Features& a, const Features& b) const {
  return describe::CosineDistance(a, b);
}

}  // namespace mapweld::baselines
