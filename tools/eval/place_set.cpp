// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/place_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace mapweld::eval {

void PlaceSet::AddSession(const std::string& name, const std::vector<geom::Vec3d>& positions) {
  if (positions.size() < 3) {
    throw std::runtime_error(
        fmt::format("{} has {} keyframes; recognising places needs at least 3", name, positions.size()));
  }
  double path_m = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (i > 0) path_m += (positions[i] - positions[i - 1]).norm();
    const geom::Vec3d& before = positions[i > 0 ? i - 1 : 0];
    const geom::Vec3d& after = positions[std::min(i + 1, positions.size() - 1)];
    keyframes_.push_back(
        {sessions_, positions[i], Eigen::Vector2d((after - before).head<2>()).stableNormalized(), path_m});
  }
  ++sessions_;
}

bool PlaceSet::IsCandidate(int query, int j) const {
  if (sessions_ > 1) return At(query).session != At(j).session;
  return At(query).path_m - At(j).path_m >= kRevisitGap_m;
}

double PlaceSet::Metres(int i, int j) const {
  return (At(i).position - At(j).position).norm();
}

geom::Vec3d PlaceSet::LeftOf(int i, double left_m) const {
  const Eigen::Vector2d& travel = At(i).travel;
  return At(i).position + left_m * geom::Vec3d{-travel.y(), travel.x(), 0};
}

Direction PlaceSet::DirectionBetween(int i, int j) const {
  const double cosine = At(i).travel.dot(At(j).travel);
  if (cosine > 0.5) return Direction::kForward;
  return cosine < -0.5 ? Direction::kReverse : Direction::kCrossing;
}

}  // namespace mapweld::eval
