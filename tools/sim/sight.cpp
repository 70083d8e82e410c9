// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/sight.hpp"

#include <algorithm>
#include <cmath>

namespace mapweld::sim {

Sight::Sight(const std::vector<const Polyline*>& lines, double reach_m) {
  constexpr double kStep_m = 10;
  for (const Polyline* line : lines) {
    for (const Vec2d& p : *line) box_.Extend(p);
  }
  box_ = box_.Grown(reach_m + kCell_m);
  const Vec2d size = (box_.high - box_.low) / kCell_m;
  columns_ = static_cast<std::size_t>(std::ceil(size.x()));
  rows_ = static_cast<std::size_t>(std::ceil(size.y()));
  seen_.assign(columns_ * rows_, 0);
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(reach_m / kCell_m));
  for (const Polyline* line : lines) {
    for (const Vec2d& p : Resample(*line, kStep_m)) {
      const Vec2d at = (p - box_.low) / kCell_m;
      const auto column = static_cast<std::ptrdiff_t>(at.x());
      const auto row = static_cast<std::ptrdiff_t>(at.y());
      for (std::ptrdiff_t dy = -reach; dy <= reach; ++dy) {
        const std::ptrdiff_t y = row + dy;
        if (y < 0 || y >= static_cast<std::ptrdiff_t>(rows_)) continue;
        const auto half = static_cast<std::ptrdiff_t>(std::sqrt(static_cast<double>(reach * reach - dy * dy)));
        const std::ptrdiff_t first = std::max<std::ptrdiff_t>(column - half, 0);
        const std::ptrdiff_t last = std::min<std::ptrdiff_t>(column + half, static_cast<std::ptrdiff_t>(columns_) - 1);
        char* const cells = seen_.data() + static_cast<std::size_t>(y) * columns_;
        if (first <= last) std::fill(cells + first, cells + last + 1, 1);
      }
    }
  }
}

bool Sight::Contains(const Vec2d& p) const {
  if (!box_.Contains(p)) return false;
  const Vec2d at = (p - box_.low) / kCell_m;
  const auto column = static_cast<std::size_t>(at.x());
  const auto row = static_cast<std::size_t>(at.y());
  return column < columns_ && row < rows_ && seen_[row * columns_ + column] != 0;
}

std::vector<Vec2d> Sight::Cells() const {
  std::vector<Vec2d> cells;
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t column = 0; column < columns_; ++column) {
      if (seen_[row * columns_ + column] == 0) continue;
      cells.emplace_back(box_.low + kCell_m * Vec2d(static_cast<double>(column), static_cast<double>(row)));
    }
  }
  return cells;
}

}  // namespace mapweld::sim
