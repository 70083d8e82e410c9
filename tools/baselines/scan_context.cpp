// SPDX-License-Identifier: Apache-2.0
#include "tools/baselines/scan_context.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/place/normalize.hpp"

namespace mapweld::baselines {
namespace {

constexpr std::size_t kRings = ScanContext::kRings;
constexpr std::size_t kSectors = ScanContext::kSectors;
constexpr std::size_t kBytes = kRings * kSectors;
static_assert(kBytes <= place::kDescriptorDim + place::kSignatureDim);
using Columns = Eigen::Map<const Eigen::Matrix<float, kRings, kSectors>>;

}  // namespace

Status ScanContext::Describe(const submap::Submap& submap, place::PlaceDescription* place) {
  std::array<float, kBytes> height{};  // sector-major: the rings of one sector together
  for (const submap::SubmapPoint& p : submap.points) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return Status::kBadInput;
    const float range = std::hypot(p.x, p.y);
    if (range >= kReach_m) continue;
    const float turn = std::atan2(p.y, p.x) / (2 * std::numbers::pi_v<float>);
    const auto ring = static_cast<std::size_t>(range / kReach_m * static_cast<float>(kRings));
    const auto sector =
        std::min(static_cast<std::size_t>((turn < 0 ? turn + 1 : turn) * static_cast<float>(kSectors)), kSectors - 1);
    float& cell = height[sector * kRings + std::min(ring, kRings - 1)];
    cell = std::max(cell, p.z + kSensorHeight_m);
  }
  const auto occupied = std::count_if(height.begin(), height.end(), [](float h) { return h > 0; });
  if (static_cast<std::size_t>(occupied) < kMinCells) return Status::kBadInput;
  std::array<std::int8_t, kBytes> q;
  *place = {};
  place->descriptor.scale = place->orientation.scale = place::QuantizeToInt8(height, &q);
  std::copy_n(q.begin(), place::kDescriptorDim, place->descriptor.q.begin());
  std::copy(q.begin() + place::kDescriptorDim, q.end(), place->orientation.q.begin());
  return Status::kOk;
}

// The columns scaled to length 1; columns of zeros stay so.
describe::PlaceMethod::Features ScanContext::Prepare(const place::PlaceDescription& place) const {
  Features features(place.descriptor.q.begin(), place.descriptor.q.end());
  const auto rest = static_cast<std::ptrdiff_t>(kBytes - place.descriptor.q.size());
  features.insert(features.end(), place.orientation.q.begin(), place.orientation.q.begin() + rest);
  for (std::size_t s = 0; s < kSectors; ++s) {
    place::ScaleToLength(std::span<float>(features).subspan(s * kRings, kRings), 1);
  }
  return features;
}

float ScanContext::Distance(const Features& a, const Features& b) const {
  const Eigen::Matrix<float, kSectors, kSectors> cosine = (Columns(a.data()).transpose() * Columns(b.data())).eval();
  const auto occupied = [](const Features& f) {
    std::array<std::int8_t, kSectors> columns;
    for (std::size_t s = 0; s < kSectors; ++s) {
      columns[s] = std::any_of(f.data() + s * kRings, f.data() + (s + 1) * kRings, [](float v) { return v != 0; });
    }
    return columns;
  };
  const auto in_a = occupied(a);
  const auto in_b = occupied(b);
  float nearest = 1;
  for (std::size_t turn = 0; turn < kSectors; ++turn) {
    float sum = 0;
    int both = 0;  // columns that are empty on either side do not count
    for (std::size_t s = 0; s < kSectors; ++s) {
      const std::size_t t = s + turn < kSectors ? s + turn : s + turn - kSectors;
      sum += cosine(static_cast<Eigen::Index>(s), static_cast<Eigen::Index>(t));
      both += in_a[s] * in_b[t];
    }
    if (both > 0) nearest = std::min(nearest, 1 - sum / static_cast<float>(both));
  }
  return nearest;
}

}  // namespace mapweld::baselines
