// SPDX-License-Identifier: Apache-2.0
#include "core/place/column_grid.hpp"

#include <algorithm>
#include <cmath>

namespace mapweld::place {
namespace {

std::int32_t ToQ8(float metres) {
  return static_cast<std::int32_t>(std::floor(metres * kQ8 + 0.5F));
}

bool IsSane(float v) {
  return std::abs(v) <= ColumnGrid::kMaxCoordinate_m;
}  // false for NaN

// First and second moments of integer coordinates: sums of integers do not depend on the order.
struct Moments {
  std::int64_t n = 0;
  std::array<std::int64_t, 3> sum{};
  std::array<std::int64_t, 6> square{};  // xx xy xz yy yz zz

  void Add(std::int64_t x, std::int64_t y, std::int64_t z) {
    ++n;
    sum[0] += x, sum[1] += y, sum[2] += z;
    square[0] += x * x, square[1] += x * y, square[2] += x * z;
    square[3] += y * y, square[4] += y * z, square[5] += z * z;
  }

  // det / (sum of the principal 2 x 2 minors) of the covariance lies between a third of the smallest eigenvalue and the
  // eigenvalue itself; minors / trace does the same for the middle one. Enough to tell a plane or a line from a place.
  [[nodiscard]] bool IsFlat(double sigma_q8) const {
    const auto count = static_cast<double>(n);
    const auto cov = [&](std::size_t k, std::size_t i, std::size_t j) {
      return static_cast<double>(square[k]) / count -
             static_cast<double>(sum[i]) / count * (static_cast<double>(sum[j]) / count);
    };
    const double xx = cov(0, 0, 0);
    const double xy = cov(1, 0, 1);
    const double xz = cov(2, 0, 2);
    const double yy = cov(3, 1, 1);
    const double yz = cov(4, 1, 2);
    const double zz = cov(5, 2, 2);
    const double minor_x = yy * zz - yz * yz;
    const double minors = minor_x + (xx * zz - xz * xz) + (xx * yy - xy * xy);
    const double det = xx * minor_x - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    const double variance = sigma_q8 * sigma_q8;
    const bool is_line = minors <= variance * (xx + yy + zz);
    return is_line || det <= variance / 3 * minors;
  }
};

constexpr double kFlatSigmaQ8 = 0.05 * kQ8;

}  // namespace

Status ColumnGrid::Build(std::span<const submap::SubmapPoint> points, std::size_t min_points) {
  MAPWELD_ASSERT(points.size() <= kCap.submap_points);
  cells_.fill(Cell{});
  Moments moments;
  for (const submap::SubmapPoint& p : points) {
    if (!IsSane(p.x) || !IsSane(p.y) || !IsSane(p.z)) return Status::kBadInput;
    const Place at = MakePlace(p);
    if (!at.is_inside) continue;
    moments.Add(at.x_q8, at.y_q8, at.z_q8);
    Cell& cell = cells_[at.cell];
    cell.lowest_q8 = std::min(cell.lowest_q8, at.z_q8);
  }
  if (moments.n < static_cast<std::int64_t>(min_points) || moments.IsFlat(kFlatSigmaQ8)) return Status::kBadInput;

  for (const submap::SubmapPoint& p : points) {
    const Place at = MakePlace(p);
    if (!at.is_inside) continue;
    Cell& cell = cells_[at.cell];
    if (cell.lowest_around_q8 == kEmptyQ8) cell.lowest_around_q8 = LowestAround(at.cell);
    const std::int32_t height_q8 = at.z_q8 - cell.lowest_around_q8;
    if (height_q8 >= kTopHeightQ8) continue;
    const std::int32_t weight =
        height_q8 >= kFullHeightQ8 ? kQ8 : kLowestWeightQ8 + (kQ8 - kLowestWeightQ8) * height_q8 / kFullHeightQ8;
    cell.weight_q8 += weight;
    if (height_q8 >= kTallHeightQ8) cell.tall_q8 += weight;
    if (height_q8 >= kHighHeightQ8) cell.high_q8 += weight;
    cell.x_moment_q16 += weight * ((at.x_q8 + kReachQ8) % kCellQ8);
    cell.y_moment_q16 += weight * ((at.y_q8 + kReachQ8) % kCellQ8);
  }
  return Status::kOk;
}

ColumnGrid::Place ColumnGrid::MakePlace(const submap::SubmapPoint& p) {
  Place at{.x_q8 = ToQ8(p.x), .y_q8 = ToQ8(p.y), .z_q8 = ToQ8(p.z)};
  const auto inside = [](std::int32_t v) { return v >= -kReachQ8 && v < kReachQ8; };
  at.is_inside = inside(at.x_q8) && inside(at.y_q8);
  if (at.is_inside) {
    const auto column = static_cast<std::size_t>((at.x_q8 + kReachQ8) / kCellQ8);
    const auto row = static_cast<std::size_t>((at.y_q8 + kReachQ8) / kCellQ8);
    at.cell = row * kSide + column;
  }
  return at;
}

std::int32_t ColumnGrid::LowestAround(std::size_t index) const {
  const std::size_t row = index / kSide;
  const std::size_t column = index % kSide;
  std::int32_t lowest = kEmptyQ8;
  for (std::size_t r = row - std::min<std::size_t>(row, 1); r <= std::min(row + 1, kSide - 1); ++r) {
    for (std::size_t c = column - std::min<std::size_t>(column, 1); c <= std::min(column + 1, kSide - 1); ++c) {
      lowest = std::min(lowest, cells_[r * kSide + c].lowest_q8);
    }
  }
  return lowest;
}

Column ColumnGrid::MakeColumn(std::size_t index) const {
  const Cell& cell = cells_[index];
  const auto x0 = static_cast<std::int32_t>(index % kSide) * kCellQ8 - kReachQ8;
  const auto y0 = static_cast<std::int32_t>(index / kSide) * kCellQ8 - kReachQ8;
  Column column{.x_q8 = x0 + cell.x_moment_q16 / cell.weight_q8,
                .y_q8 = y0 + cell.y_moment_q16 / cell.weight_q8,
                .weight_q8 = std::min(cell.weight_q8, kMaxWeightQ8),
                .tall_q8 = std::min(cell.tall_q8, kMaxWeightQ8),
                .high_q8 = std::min(cell.high_q8, kMaxWeightQ8)};
  const auto x = static_cast<float>(column.x_q8);
  const auto y = static_cast<float>(column.y_q8);
  column.range_q8 = static_cast<std::int32_t>(std::sqrt(x * x + y * y));
  return column;
}

}  // namespace mapweld::place
