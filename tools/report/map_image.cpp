// SPDX-License-Identifier: Apache-2.0
#include "tools/report/map_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace mapweld::report {
namespace {

constexpr double kFinestPixel_m = 0.5;  // about the voxel of the map: finer pixels would only leave holes
constexpr double kPixelsPerUnit = 2;    // for sharp screens
constexpr double kGroundCell_m = 8;
constexpr double kHighest_m = 14;  // the colour scale ends at the eaves of a four-storey house
constexpr int kHeightLevels = 16;
constexpr int kDensityLevels = 15;

struct Range {
  double low = 0;
  double high = 0;
};

// From the 0.1 % to the 99.9 % point. Sampled, so that a map of a whole city costs no more than one of a street.
Range Bulk(const std::vector<MapPoint>& points, Eigen::Index axis) {
  std::vector<float> values;
  const std::size_t step = points.size() / 200'000 + 1;
  for (std::size_t i = 0; i < points.size(); i += step) values.push_back(points[i].p_merged(axis));
  if (values.empty()) return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const std::size_t cut = values.size() / 1000;
  std::sort(values.begin(), values.end());
  return {static_cast<double>(values[cut]), static_cast<double>(values[values.size() - 1 - cut])};
}

// Height of the ground over a grid of squares.
class Ground {
 public:
  Ground(const std::vector<MapPoint>& points, const MapView& view) : view_(view) {
    columns_ = static_cast<int>(view.width * view.m_per_unit / kGroundCell_m) + 1;
    rows_ = static_cast<int>(view.height * view.m_per_unit / kGroundCell_m) + 1;
    std::vector<std::array<float, 3>> lowest(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (auto& three : lowest) three.fill(std::numeric_limits<float>::infinity());
    for (const MapPoint& point : points) {
      auto& three = lowest[CellOf(point.p_merged)];
      if (!(point.p_merged.z() < three[2])) continue;
      three[2] = point.p_merged.z();
      std::sort(three.begin(), three.end());
    }
    // The third lowest: one or two points below the ground are reflections.
    height_.reserve(lowest.size());
    for (const auto& three : lowest) height_.push_back(std::isfinite(three[2]) ? three[2] : three[0]);
    Smooth();
  }

  [[nodiscard]] float Below(const Eigen::Vector3f& p) const { return height_[CellOf(p)]; }

 private:
  [[nodiscard]] std::size_t CellOf(const Eigen::Vector3f& p) const {
    const double u = (static_cast<double>(p.x()) - view_.left_m) / kGroundCell_m;
    const double v = (view_.top_m - static_cast<double>(p.y())) / kGroundCell_m;
    const int column = static_cast<int>(std::clamp(u, 0.0, columns_ - 1.0));
    const int row = static_cast<int>(std::clamp(v, 0.0, rows_ - 1.0));
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  // A square that holds nothing but a roof takes the ground of its neighbours.
  void Smooth() {
    const std::vector<float> before = height_;
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        std::vector<float> near;
        for (int r = std::max(row - 1, 0); r <= std::min(row + 1, rows_ - 1); ++r) {
          for (int c = std::max(column - 1, 0); c <= std::min(column + 1, columns_ - 1); ++c) {
            const float h = before[static_cast<std::size_t>(r * columns_ + c)];
            if (std::isfinite(h)) near.push_back(h);
          }
        }
        if (near.empty()) continue;
        const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
        std::nth_element(near.begin(), middle, near.end());
        float& own = height_[static_cast<std::size_t>(row * columns_ + column)];
        own = std::min(own, *middle);
      }
    }
  }

  MapView view_;
  int columns_ = 1;
  int rows_ = 1;
  std::vector<float> height_;
};

// From slate over grey-blue to ivory: quiet, so that the drives' colours stand out, and readable in print.
std::vector<std::array<std::uint8_t, 4>> MapPalette() {
  constexpr double kStops[4][3] = {{70, 88, 112}, {112, 136, 160}, {188, 196, 198}, {250, 240, 214}};
  std::vector<std::array<std::uint8_t, 4>> palette = {{0, 0, 0, 0}};
  for (int h = 0; h < kHeightLevels; ++h) {
    const double at = 3.0 * h / (kHeightLevels - 1);
    const auto stop = static_cast<std::size_t>(std::min(at, 2.0));
    const double share = at - static_cast<double>(stop);
    for (int d = 1; d <= kDensityLevels; ++d) {
      std::array<std::uint8_t, 4> color{};
      for (std::size_t i = 0; i < 3; ++i) {
        color[i] = static_cast<std::uint8_t>(std::lround((1 - share) * kStops[stop][i] + share * kStops[stop + 1][i]));
      }
      color[3] = static_cast<std::uint8_t>(255 * (0.25 + 0.75 * d / kDensityLevels));
      palette.push_back(color);
    }
  }
  return palette;
}

}  // namespace

MapView FitView(const std::vector<MapPoint>& points, const std::vector<std::vector<geom::Pose3>>& trajectories,
                double most_width, double most_height) {
  constexpr double kMargin_m = 8;
  Range range[2] = {Bulk(points, 0), Bulk(points, 1)};
  for (const auto& trajectory : trajectories) {
    for (const geom::Pose3& pose : trajectory) {
      for (Eigen::Index axis = 0; axis < 2; ++axis) {
        range[axis].low = std::min(range[axis].low, pose.t(axis));
        range[axis].high = std::max(range[axis].high, pose.t(axis));
      }
    }
  }
  if (!(range[0].low <= range[0].high && range[1].low <= range[1].high)) range[0] = range[1] = {0, 0};
  for (Range& r : range) {
    r.low -= kMargin_m;
    r.high += kMargin_m;
  }
  // No flatter than 3:1, so that a single straight road still is a picture.
  double extent_x = range[0].high - range[0].low;
  double extent_y = range[1].high - range[1].low;
  const double missing = extent_x / 3 - extent_y;
  if (missing > 0) {
    range[1].high += missing / 2;
    extent_y += missing;
  }
  MapView view;
  view.m_per_unit = std::max(extent_x / most_width, extent_y / most_height);
  view.left_m = range[0].low;
  view.top_m = range[1].high;
  view.width = extent_x / view.m_per_unit;
  view.height = extent_y / view.m_per_unit;
  return view;
}

PaletteImage RenderMap(const std::vector<MapPoint>& points, const MapView& view) {
  const double pixel_m = std::max(view.m_per_unit / kPixelsPerUnit, kFinestPixel_m);
  PaletteImage image;
  image.palette = MapPalette();
  image.width = std::max(1, static_cast<int>(std::ceil(view.width * view.m_per_unit / pixel_m)));
  image.height = std::max(1, static_cast<int>(std::ceil(view.height * view.m_per_unit / pixel_m)));
  const auto size = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  const Ground ground(points, view);
  std::vector<std::uint32_t> count(size);
  std::vector<float> height(size);
  for (const MapPoint& point : points) {
    const double u = std::floor((static_cast<double>(point.p_merged.x()) - view.left_m) / pixel_m);
    const double v = std::floor((view.top_m - static_cast<double>(point.p_merged.y())) / pixel_m);
    if (!(u >= 0 && v >= 0 && u < image.width && v < image.height)) continue;
    const auto at = static_cast<std::size_t>(v) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(u);
    ++count[at];
    height[at] = std::max(height[at], point.p_merged.z() - ground.Below(point.p_merged));
  }
  std::vector<std::uint32_t> occupied;
  std::copy_if(count.begin(), count.end(), std::back_inserter(occupied), [](std::uint32_t n) { return n > 0; });
  double full = 1;  // the count that is fully opaque: all but the densest hundredth stay below
  if (!occupied.empty()) {
    const auto rank = occupied.begin() + static_cast<std::ptrdiff_t>(occupied.size() * 97 / 100);
    std::nth_element(occupied.begin(), rank, occupied.end());
    full = std::max(2.0, static_cast<double>(*rank));
  }
  image.pixels.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    if (count[i] == 0) continue;
    const double density = std::min(1.0, std::log1p(static_cast<double>(count[i])) / std::log1p(full));
    const double h = std::clamp(static_cast<double>(height[i]) / kHighest_m, 0.0, 1.0);
    const int d = std::clamp(static_cast<int>(std::ceil(density * kDensityLevels)), 1, kDensityLevels);
    const int level = static_cast<int>(std::lround(std::sqrt(h) * (kHeightLevels - 1)));
    image.pixels[i] = static_cast<std::uint8_t>(1 + level * kDensityLevels + d - 1);
  }
  return image;
}

}  // namespace mapweld::report
