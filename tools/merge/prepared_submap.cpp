// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/prepared_submap.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/merge/surfel_moments.hpp"

namespace mapweld::merge {
namespace {

constexpr std::size_t kMaxSamples = 1600;
constexpr std::size_t kMaxStructureSamples = 1000;
constexpr float kBevLow_m = 0.3F;   // height range in a cell that is still ground
constexpr float kBevHigh_m = 2.3F;  // and from where on a structure counts fully

int ColumnOf(float x) {
  return static_cast<int>(x + PreparedSubmap::kHalfSize_m);
}
std::size_t ColumnOf(const Eigen::Vector3f& p) {
  return static_cast<std::size_t>(ColumnOf(p.x()) * PreparedSubmap::kColumns + ColumnOf(p.y()));
}

// Up to `most` of the list, far apart in it from one to the next: multiplication by the golden ratio spreads 0..n-1.
std::vector<std::uint32_t> MixedOrder(std::vector<std::uint32_t> list, std::size_t most) {
  const auto key = [](std::uint32_t i) { return i * 2654435769U; };
  const auto end = list.begin() + static_cast<std::ptrdiff_t>(std::min(most, list.size()));
  std::partial_sort(list.begin(), end, list.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  list.erase(end, list.end());
  return list;
}

}  // namespace

PreparedSubmap::PreparedSubmap(const SubmapCloud& cloud) {
  SortIntoColumns(cloud);
  FindBounds();
  MakeSurfels();
  FindShapes();
  DrawBev();
  ChooseSamples();
}

void PreparedSubmap::SortIntoColumns(const SubmapCloud& cloud) {
  const auto inside = [](const Eigen::Vector3f& p) {
    return std::abs(p.x()) < kHalfSize_m - 1 && std::abs(p.y()) < kHalfSize_m - 1 && std::abs(p.z()) < 1000;
  };
  point_begin_.assign(kColumns * kColumns + 1, 0);
  for (const Eigen::Vector3f& p : cloud.points) {
    if (inside(p)) ++point_begin_[ColumnOf(p) + 1];
  }
  for (std::size_t i = 1; i < point_begin_.size(); ++i) point_begin_[i] += point_begin_[i - 1];
  points_.resize(point_begin_.back());
  std::vector<std::uint32_t> next = point_begin_;
  for (const Eigen::Vector3f& p : cloud.points) {
    if (inside(p)) points_[next[ColumnOf(p)]++] = p;
  }
  lowest_.assign(kCoverCells * kCoverCells, std::numeric_limits<float>::quiet_NaN());
  for (const Eigen::Vector3f& p : points_) {
    float& z = lowest_[static_cast<std::size_t>(ColumnOf(p.x()) / 4 * kCoverCells + ColumnOf(p.y()) / 4)];
    if (!(z < p.z())) z = p.z();
  }
}

void PreparedSubmap::FindBounds() {
  if (points_.empty()) return;
  std::vector<float> values(points_.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points_.begin(), points_.end(), values.begin(), [&](const Eigen::Vector3f& p) { return p[axis]; });
    const auto at = [&](std::size_t twentieths) {
      const auto nth = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * twentieths / 20);
      std::nth_element(values.begin(), nth, values.end());
      return *nth;
    };
    low_[axis] = at(1);
    high_[axis] = at(19);
  }
}

void PreparedSubmap::MakeSurfels() {
  surfel_of_.resize(points_.size());
  surfel_begin_.assign(1, 0);
  std::vector<std::pair<float, std::uint32_t>> column;  // (height, point)
  for (std::size_t c = 0; c < kColumns * kColumns; ++c) {
    column.clear();
    for (std::uint32_t i = point_begin_[c]; i < point_begin_[c + 1]; ++i) column.emplace_back(points_[i].z(), i);
    std::sort(column.begin(), column.end());
    float floor_z = 0;
    float n = 0;
    for (const auto& [z, i] : column) {
      if (n == 0 || std::floor(z) != floor_z) {
        surfels_.emplace_back();
        floor_z = std::floor(z);
        n = 0;
      }
      n += 1;
      surfels_.back().mean += (points_[i] - surfels_.back().mean) / n;
      surfel_of_[i] = static_cast<std::uint32_t>(surfels_.size() - 1);
    }
    surfel_begin_.push_back(static_cast<std::uint32_t>(surfels_.size()));
  }
}

void PreparedSubmap::FindShapes() {
  std::vector<SurfelMoments> moments(surfels_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) moments[surfel_of_[i]].Add(points_[i]);
  for (int x = 1; x < kColumns - 1; ++x) {
    for (int y = 1; y < kColumns - 1; ++y) {
      const auto c = static_cast<std::size_t>(x * kColumns + y);
      for (std::uint32_t s = surfel_begin_[c]; s < surfel_begin_[c + 1]; ++s) {
        SurfelMoments sum;
        const float level = std::floor(surfels_[s].mean.z());
        for (int row = x - 1; row <= x + 1; ++row) {
          const auto middle = static_cast<std::size_t>(row * kColumns + y);
          for (std::uint32_t k = surfel_begin_[middle - 1]; k < surfel_begin_[middle + 2]; ++k) {
            if (std::abs(std::floor(surfels_[k].mean.z()) - level) < 1.5F) sum.Add(moments[k]);
          }
        }
        sum.Describe(&surfels_[s]);
      }
    }
  }
}

void PreparedSubmap::DrawBev() {
  static_assert(BevImage::kFine == kColumns && BevImage::kCoarse * 2 == kColumns);
  std::vector<std::uint8_t> fine(kColumns * kColumns, 0);
  for (std::size_t c = 0; c < fine.size(); ++c) {
    float low = std::numeric_limits<float>::max();
    float high = std::numeric_limits<float>::lowest();
    for (std::uint32_t k = point_begin_[c]; k < point_begin_[c + 1]; ++k) {
      low = std::min(low, points_[k].z());
      high = std::max(high, points_[k].z());
    }
    const float share = std::clamp((high - low - kBevLow_m) / (kBevHigh_m - kBevLow_m), 0.0F, 1.0F);
    fine[c] = static_cast<std::uint8_t>(std::lround(share * BevImage::kFull));
  }
  std::vector<std::uint8_t> coarse(BevImage::kCoarse * BevImage::kCoarse, 0);
  for (std::size_t c = 0; c < fine.size(); ++c) {
    std::uint8_t& to = coarse[c / kColumns / 2 * BevImage::kCoarse + c % kColumns / 2];
    to = std::max(to, fine[c]);
  }
  bev_.fine_contrast = Contrast(fine, kColumns);
  bev_.coarse_contrast = Contrast(coarse, BevImage::kCoarse);
  for (std::uint8_t value = BevImage::kFull; value > 0; --value) {
    std::vector<std::uint32_t> of_value;
    for (std::uint32_t c = 0; c < fine.size(); ++c) {
      if (fine[c] == value) of_value.push_back(c);
    }
    for (const std::uint32_t c : MixedOrder(of_value, BevImage::kStrongest)) {
      if (bev_.strongest.size() == BevImage::kStrongest) return;
      bev_.strongest.emplace_back(static_cast<float>(c / kColumns) + 0.5F - kHalfSize_m,
                                  static_cast<float>(c % kColumns) + 0.5F - kHalfSize_m);
    }
  }
}

std::vector<std::int8_t> PreparedSubmap::Contrast(const std::vector<std::uint8_t>& image, std::size_t size) const {
  const float cell_m = 2 * kHalfSize_m / static_cast<float>(size);
  std::vector<bool> seen(image.size());
  int cells = 0;
  int sum = 0;
  for (std::size_t c = 0; c < image.size(); ++c) {
    const Eigen::Vector3f center((static_cast<float>(c / size) + 0.5F) * cell_m - kHalfSize_m,
                                 (static_cast<float>(c % size) + 0.5F) * cell_m - kHalfSize_m, 0);
    seen[c] = Covers(center);
    cells += seen[c] ? 1 : 0;
    sum += image[c];
  }
  const int twice_mean = cells > 0 ? (2 * sum + cells / 2) / cells : 0;
  std::vector<std::int8_t> out(image.size(), BevImage::kUnseen);
  for (std::size_t c = 0; c < image.size(); ++c) {
    if (seen[c]) out[c] = static_cast<std::int8_t>(2 * image[c] - twice_mean);
  }
  return out;
}

void PreparedSubmap::ChooseSamples() {
  std::vector<std::uint32_t> structure;
  std::vector<std::uint32_t> ground;
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    (surfels_[surfel_of_[i]].is_structure ? structure : ground).push_back(i);
  }
  samples_ = MixedOrder(std::move(structure), kMaxSamples * 3 / 4);
  structure_samples_.assign(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(
                                                                     std::min(samples_.size(), kMaxStructureSamples)));
  ground = MixedOrder(std::move(ground), kMaxSamples - samples_.size());
  samples_.insert(samples_.end(), ground.begin(), ground.end());
  samples_ = MixedOrder(std::move(samples_), kMaxSamples);
}

int PreparedSubmap::NearestSurfel(const Eigen::Vector3f& p, float max_distance_m) const {
  if (!(std::abs(p.x()) < kHalfSize_m - 4 && std::abs(p.y()) < kHalfSize_m - 4)) return -1;
  float best = max_distance_m * max_distance_m;
  int found = -1;
  const int y_begin = ColumnOf(p.y() - max_distance_m);
  const int y_end = ColumnOf(p.y() + max_distance_m);
  for (int x = ColumnOf(p.x() - max_distance_m); x <= ColumnOf(p.x() + max_distance_m); ++x) {
    const std::size_t begin = surfel_begin_[static_cast<std::size_t>(x * kColumns + y_begin)];
    const std::size_t end = surfel_begin_[static_cast<std::size_t>(x * kColumns + y_end) + 1];
    for (std::size_t k = begin; k < end; ++k) {
      const float d2 = (surfels_[k].mean - p).squaredNorm();
      if (d2 < best) {
        best = d2;
        found = static_cast<int>(k);
      }
    }
  }
  return found;
}

bool PreparedSubmap::HasPoint(const Eigen::Vector3f& p, float max_distance_m) const {
  if (!(std::abs(p.x()) < kHalfSize_m - 4 && std::abs(p.y()) < kHalfSize_m - 4)) return false;
  const int y_begin = ColumnOf(p.y() - max_distance_m);
  const int y_end = ColumnOf(p.y() + max_distance_m);
  for (int x = ColumnOf(p.x() - max_distance_m); x <= ColumnOf(p.x() + max_distance_m); ++x) {
    const std::size_t begin = point_begin_[static_cast<std::size_t>(x * kColumns + y_begin)];
    const std::size_t end = point_begin_[static_cast<std::size_t>(x * kColumns + y_end) + 1];
    for (std::size_t k = begin; k < end; ++k) {
      if ((points_[k] - p).squaredNorm() < max_distance_m * max_distance_m) return true;
    }
  }
  return false;
}

bool PreparedSubmap::Covers(const Eigen::Vector3f& p) const {
  const int x = static_cast<int>(std::floor((p.x() + kHalfSize_m) / 4 - 0.5F));
  const int y = static_cast<int>(std::floor((p.y() + kHalfSize_m) / 4 - 0.5F));
  for (const int i : {x, x + 1}) {
    for (const int j : {y, y + 1}) {
      if (i < 0 || j < 0 || i >= kCoverCells || j >= kCoverCells) continue;
      if (!std::isnan(lowest_[static_cast<std::size_t>(i * kCoverCells + j)])) return true;
    }
  }
  return false;
}

}  // namespace mapweld::merge
