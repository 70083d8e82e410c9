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
constexpr int kHeightLevels = 16;
constexpr int kDensityLevels = 15;

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

// What to show along one axis: the trajectories, what was seen within a submap's radius of them, and the bulk of the
// points, from the 0.1 % to the 99.9 % one.
Range Shown(const std::vector<MapPoint>& points, const std::vector<std::vector<geom::Pose3>>& trajectories,
            Eigen::Index axis) {
  constexpr double kSubmapRadius_m = 50;
  constexpr double kMargin_m = 6;
  Range drives;
  for (const auto& trajectory : trajectories) {
    for (const geom::Pose3& pose : trajectory) drives.Include(pose.t(axis));
  }
  Range seen;
  std::vector<float> sample;  // so that a whole city costs no more than a street
  const std::size_t step = points.size() / 200'000 + 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    seen.Include(static_cast<double>(points[i].p_merged(axis)));
    if (i % step == 0) sample.push_back(points[i].p_merged(axis));
  }
  Range shown = drives;
  if (!sample.empty()) {
    std::sort(sample.begin(), sample.end());
    const std::size_t cut = sample.size() / 1000;
    shown.Include(static_cast<double>(sample[cut]));
    shown.Include(static_cast<double>(sample[sample.size() - 1 - cut]));
    if (std::isfinite(drives.low)) {
      shown.Include(std::max(seen.low, drives.low - kSubmapRadius_m));
      shown.Include(std::min(seen.high, drives.high + kSubmapRadius_m));
    }
  }
  if (!(std::isfinite(shown.low) && std::isfinite(shown.high))) return {-kMargin_m, kMargin_m};
  return {shown.low - kMargin_m, shown.high + kMargin_m};
}

// Of all values; reorders them. Zero for none.
template <class T>
T Quantile(std::vector<T>* values, double share) {
  if (values->empty()) return T{};
  const auto rank = values->begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values->size() - 1));
  std::nth_element(values->begin(), rank, values->end());
  return *rank;
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

// From slate over grey-green to ivory: quiet, so that the drives' colours stand out, and readable in print.
std::vector<std::array<std::uint8_t, 4>> MapPalette() {
  constexpr double kStops[4][3] = {{66, 84, 122}, {86, 140, 160}, {166, 190, 164}, {255, 238, 196}};
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
      // The ground is everywhere and would hide what stands on it.
      color[3] = static_cast<std::uint8_t>(255 * (0.25 + 0.75 * d / kDensityLevels) * std::min(1.0, 0.45 + 0.2 * h));
      palette.push_back(color);
    }
  }
  return palette;
}

}  // namespace

MapView FitView(const std::vector<MapPoint>& points, const std::vector<std::vector<geom::Pose3>>& trajectories,
                double most_width, double most_height) {
  Range range[2] = {Shown(points, trajectories, 0), Shown(points, trajectories, 1)};
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
  std::vector<std::uint32_t> counts;
  std::vector<float> heights;
  for (std::size_t i = 0; i < size; ++i) {
    if (count[i] == 0) continue;
    counts.push_back(count[i]);
    heights.push_back(height[i]);
  }
  // The scales end where all but a few pixels are below, whatever the sensor and the town.
  const double full = std::max(2.0, static_cast<double>(Quantile(&counts, 0.97)));
  const double highest_m = std::clamp(static_cast<double>(Quantile(&heights, 0.98)), 2.0, 25.0);
  image.pixels.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    if (count[i] == 0) continue;
    const double density = std::min(1.0, std::log1p(static_cast<double>(count[i])) / std::log1p(full));
    const double h = std::clamp(static_cast<double>(height[i]) / highest_m, 0.0, 1.0);
    const int d = std::clamp(static_cast<int>(std::ceil(density * kDensityLevels)), 1, kDensityLevels);
    const int level = static_cast<int>(std::lround(std::sqrt(h) * (kHeightLevels - 1)));
    image.pixels[i] = static_cast<std::uint8_t>(1 + level * kDensityLevels + d - 1);
  }
  return image;
}

}  // namespace mapweld::report
