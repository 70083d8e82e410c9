// SPDX-License-Identifier: Apache-2.0
#include "tools/baselines/solid.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/place/normalize.hpp"
#include "tools/describe/cosine.hpp"

namespace mapweld::baselines {
namespace {

// The cell 0..count - 1 of a value that runs from 0 to 1.
Eigen::Index CellOf(float share, std::size_t count) {
  const auto cell = static_cast<std::int64_t>(share * static_cast<float>(count));
  return static_cast<Eigen::Index>(std::clamp<std::int64_t>(cell, 0, static_cast<std::int64_t>(count) - 1));
}

// `values` as the first bytes of `q`.
template <std::size_t M, class Vector>
float Quantize(const Vector& values, std::array<std::int8_t, M>* q) {
  std::array<float, M> padded{};
  std::copy(values.data(), values.data() + values.size(), padded.begin());
  return place::QuantizeToInt8(padded, q);
}

}  // namespace

Status Solid::Describe(const submap::Submap& submap, place::PlaceDescription* place) {
  Eigen::Matrix<float, kRanges, kElevations> by_range = by_range.Zero();
  Eigen::Matrix<float, kAngles, kElevations> by_angle = by_angle.Zero();
  std::size_t used = 0;
  for (const submap::SubmapPoint& p : submap.points) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return Status::kBadInput;
    const float range = std::hypot(p.x, p.y);
    const float elevation_deg = std::atan2(p.z, range) * 180 / std::numbers::pi_v<float>;
    if (range < kNearest_m || range > kReach_m || elevation_deg < kLowest_deg || elevation_deg > kHighest_deg) continue;
    const float turn = std::atan2(p.y, p.x) / (2 * std::numbers::pi_v<float>);
    const Eigen::Index elevation = CellOf((elevation_deg - kLowest_deg) / (kHighest_deg - kLowest_deg), kElevations);
    by_range(CellOf(range / kReach_m, kRanges), elevation) += 1;
    by_angle(CellOf(turn < 0 ? turn + 1 : turn, kAngles), elevation) += 1;
    ++used;
  }
  if (used < kMinPoints) return Status::kBadInput;
  Eigen::Matrix<float, kElevations, 1> weight = by_range.colwise().sum().transpose();
  const float fewest = weight.minCoeff();
  const float span = weight.maxCoeff() - fewest;
  if (span <= 0) return Status::kBadInput;
  weight = (weight.array() - fewest) / span;
  *place = {};
  place->descriptor.scale = Quantize(Eigen::Matrix<float, kRanges, 1>(by_range * weight), &place->descriptor.q);
  place->orientation.scale = Quantize(Eigen::Matrix<float, kAngles, 1>(by_angle * weight), &place->orientation.q);
  return Status::kOk;
}

describe::PlaceMethod::Features Solid::Prepare(const place::PlaceDescription& place) const {
  return describe::UnitFeatures(place.descriptor, kRanges);
}

float Solid::Distance(const Features& a, const Features& b) const {
  return describe::CosineDistance(a, b);
}

}  // namespace mapweld::baselines
