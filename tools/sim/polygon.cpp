// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mapweld::sim {

double SignedArea(const Polyline& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) twice += Cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return twice / 2;
}

double Length(const Polyline& line) {
  double sum = 0;
  for (std::size_t i = 1; i < line.size(); ++i) sum += (line[i] - line[i - 1]).norm();
  return sum;
}

double DistanceToSegment(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
  const Vec2d d = b - a;
  const double u = std::clamp((p - a).dot(d) / std::max(d.squaredNorm(), 1e-12), 0.0, 1.0);
  return (p - a - u * d).norm();
}

bool Inside(const Polyline& polygon, const Vec2d& p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vec2d& a = polygon[i];
    const Vec2d& b = polygon[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) {
      inside = !inside;
    }
  }
  return inside;
}

double DistanceToPolygon(const Polyline& polygon, const Vec2d& p) {
  if (Inside(polygon, p)) return 0;
  double best = 1e300;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    best = std::min(best, DistanceToSegment(p, polygon[i], polygon[(i + 1) % polygon.size()]));
  }
  return best;
}

namespace {

bool IsEar(const Polyline& polygon, const std::vector<std::uint32_t>& left, std::size_t k) {
  const std::size_t n = left.size();
  const Vec2d& a = polygon[left[(k + n - 1) % n]];
  const Vec2d& b = polygon[left[k]];
  const Vec2d& c = polygon[left[(k + 1) % n]];
  if (Cross(b - a, c - b) <= 0) return false;
  return std::none_of(left.begin(), left.end(), [&](std::uint32_t i) {
    const Vec2d& p = polygon[i];
    if (p == a || p == b || p == c) return false;
    return Cross(b - a, p - a) >= 0 && Cross(c - b, p - b) >= 0 && Cross(a - c, p - c) >= 0;
  });
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> Triangulate(const Polyline& polygon) {
  std::vector<std::uint32_t> left(polygon.size());
  std::iota(left.begin(), left.end(), 0U);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  while (left.size() >= 3) {
    std::size_t ear = 0;
    while (ear < left.size() && !IsEar(polygon, left, ear)) ++ear;
    if (ear == left.size()) break;
    const std::size_t n = left.size();
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

Polyline Resample(const Polyline& line, double spacing) {
  const double length = Length(line);
  const auto steps = static_cast<std::size_t>(std::max(1.0, std::round(length / spacing)));
  const double step = length / static_cast<double>(steps);
  Polyline out;
  out.reserve(steps + 1);
  out.push_back(line.front());
  std::size_t segment = 1;
  double behind = 0;  // length of the segments already passed
  for (std::size_t i = 1; i < steps; ++i) {
    const double want = step * static_cast<double>(i);
    while (segment + 1 < line.size() && behind + (line[segment] - line[segment - 1]).norm() < want) {
      behind += (line[segment] - line[segment - 1]).norm();
      ++segment;
    }
    const double here = std::max((line[segment] - line[segment - 1]).norm(), 1e-12);
    out.push_back(line[segment - 1] + (line[segment] - line[segment - 1]) * ((want - behind) / here));
  }
  out.push_back(line.back());
  return out;
}

}  // namespace mapweld::sim
