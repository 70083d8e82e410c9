// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/bev_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace mapweld::merge {
namespace {

constexpr int kCoarseYaws = 72;
constexpr double kFineYawStep_rad = 0.03;
constexpr int kFineYaws = 2;      // steps to each side
constexpr int kFineReach = 3;     // m to each side
constexpr int kCoarseReach = 12;  // cells of 2 m to each side

// An image with a margin of zeros, so that shifted reads need no test.
struct Padded {
  int size = 0;
  int margin = 0;
  std::vector<std::uint16_t> cells;  // wide, for the products
  [[nodiscard]] int stride() const { return size + 2 * margin; }
  [[nodiscard]] const std::uint16_t* At(int x, int y) const {
    return cells.data() + (x + margin) * stride() + (y + margin);
  }
};

Padded Pad(const std::vector<std::uint8_t>& image, int size, int margin) {
  Padded out{size, margin, {}};
  out.cells.assign(static_cast<std::size_t>(out.stride() * out.stride()), 0);
  for (int x = 0; x < size; ++x) {
    const auto from = image.begin() + x * size;
    std::copy(from, from + size, out.cells.begin() + (x + margin) * out.stride() + margin);
  }
  return out;
}

std::vector<std::uint8_t> Halve(const std::vector<std::uint8_t>& image, int size) {
  const int half = size / 2;
  std::vector<std::uint8_t> out(static_cast<std::size_t>(half * half));
  for (int x = 0; x < half; ++x) {
    for (int y = 0; y < half; ++y) {
      const auto at = static_cast<std::size_t>(2 * x * size + 2 * y);
      const auto stride = static_cast<std::size_t>(size);
      out[static_cast<std::size_t>(x * half + y)] =
          std::max({image[at], image[at + 1], image[at + stride], image[at + stride + 1]});
    }
  }
  return out;
}

// Occupied cells of b turned by yaw, as cell indices of an image with `cell_m` cells; one entry per cell.
struct TurnedCell {
  int x, y;
  std::uint8_t value;
};

class Correlator {
 public:
  Correlator(const PreparedSubmap& a, const PreparedSubmap& b, int cell_m, int max_shift)
      : b_(&b), cell_m_(cell_m), size_(BevImage::kSize / cell_m) {
    const std::vector<std::uint8_t>& image = a.bev().cells;
    a_ = Pad(cell_m == 2 ? Halve(image, BevImage::kSize) : image, size_, max_shift + 1);
    turned_image_.resize(static_cast<std::size_t>(size_ * size_));
    for (const std::uint16_t value : a_.cells) a_energy_ += value * value;
  }

  // Correlation for every shift within kReach cells of (shift_x, shift_y); row-major, rows = x. At most 1200 cells of
  // at most 7 * 7 each fit 16 bits.
  template <int kReach>
  void Correlate(double yaw_rad, int shift_x, int shift_y, std::vector<std::uint16_t>* sums) {
    Turn(yaw_rad);
    constexpr int kSide = 2 * kReach + 1;
    sums->assign(static_cast<std::size_t>(kSide * kSide), 0);
    for (const TurnedCell& cell : turned_) {
      std::uint16_t* to = sums->data();
      const std::uint16_t value = cell.value;
      for (int dx = -kReach; dx <= kReach; ++dx, to += kSide) {
        const std::uint16_t* from = a_.At(cell.x + shift_x + dx, cell.y + shift_y - kReach);
        for (int dy = 0; dy < kSide; ++dy) to[dy] = static_cast<std::uint16_t>(to[dy] + value * from[dy]);
      }
    }
  }
  // Of the last Correlate.
  [[nodiscard]] double Norm() const {
    return std::sqrt(static_cast<double>(a_energy_) * static_cast<double>(turned_energy_));
  }

 private:
  void Turn(double yaw_rad) {
    std::fill(turned_image_.begin(), turned_image_.end(), std::uint8_t{0});
    const auto c = static_cast<float>(std::cos(yaw_rad));
    const auto s = static_cast<float>(std::sin(yaw_rad));
    const auto scale = 1.0F / static_cast<float>(cell_m_);
    for (const BevImage::Cell& cell : b_->bev().strongest) {
      const int x = static_cast<int>(std::floor((c * cell.x - s * cell.y + PreparedSubmap::kHalfSize_m) * scale));
      const int y = static_cast<int>(std::floor((s * cell.x + c * cell.y + PreparedSubmap::kHalfSize_m) * scale));
      if (x < 0 || y < 0 || x >= size_ || y >= size_) continue;
      std::uint8_t& to = turned_image_[static_cast<std::size_t>(x * size_ + y)];
      to = std::max(to, cell.value);
    }
    turned_.clear();
    turned_energy_ = 0;
    for (int x = 0; x < size_; ++x) {
      for (int y = 0; y < size_; ++y) {
        const std::uint8_t value = turned_image_[static_cast<std::size_t>(x * size_ + y)];
        if (value == 0) continue;
        turned_.push_back({x, y, value});
        turned_energy_ += value * value;
      }
    }
  }

  const PreparedSubmap* b_;
  int cell_m_;
  int size_;
  Padded a_;
  std::int64_t a_energy_ = 0;
  std::int64_t turned_energy_ = 0;
  std::vector<std::uint8_t> turned_image_;
  std::vector<TurnedCell> turned_;
};

bool Near(const BevPeak& a, const BevPeak& b) {
  const double turn = std::abs(std::remainder(a.yaw_rad - b.yaw_rad, 2 * std::numbers::pi));
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m) < 4 && turn < 0.35;
}

void KeepDistinct(std::vector<BevPeak>* peaks, std::size_t most) {
  std::sort(peaks->begin(), peaks->end(), [](const BevPeak& a, const BevPeak& b) {
    return a.score != b.score ? a.score > b.score : a.yaw_rad < b.yaw_rad;
  });
  std::vector<BevPeak> kept;
  for (const BevPeak& peak : *peaks) {
    if (kept.size() == most) break;
    if (std::none_of(kept.begin(), kept.end(), [&](const BevPeak& other) { return Near(peak, other); }))
      kept.push_back(peak);
  }
  peaks->swap(kept);
}

// The best shift per heading is enough: peaks of one heading that are worth a try stand out in the neighbouring one
// too.
template <int kReach>
BevPeak BestShift(Correlator* correlator, double yaw_rad, int cell_m, int shift_x, int shift_y) {
  std::vector<std::uint16_t> sums;
  correlator->Correlate<kReach>(yaw_rad, shift_x, shift_y, &sums);
  int at = 0;
  for (int i = 1; i < static_cast<int>(sums.size()); ++i) {
    if (sums[static_cast<std::size_t>(i)] > sums[static_cast<std::size_t>(at)]) at = i;
  }
  constexpr int kSide = 2 * kReach + 1;
  const double norm = correlator->Norm();
  BevPeak peak;
  peak.x_m = (at / kSide - kReach + shift_x) * cell_m;
  peak.y_m = (at % kSide - kReach + shift_y) * cell_m;
  peak.yaw_rad = yaw_rad;
  peak.score = norm > 0 ? sums[static_cast<std::size_t>(at)] / norm : 0;
  return peak;
}

}  // namespace

std::vector<BevPeak> SearchBev(const PreparedSubmap& a, const PreparedSubmap& b, int most) {
  Correlator coarse(a, b, 2, kCoarseReach);
  std::vector<BevPeak> peaks;
  for (int i = 0; i < kCoarseYaws; ++i) {
    peaks.push_back(BestShift<kCoarseReach>(&coarse, 2 * std::numbers::pi * i / kCoarseYaws, 2, 0, 0));
  }
  KeepDistinct(&peaks, static_cast<std::size_t>(2 * most));

  Correlator fine(a, b, 1, 2 * kCoarseReach + kFineReach);
  std::vector<BevPeak> refined;
  for (const BevPeak& peak : peaks) {
    BevPeak best;
    for (int i = -kFineYaws; i <= kFineYaws; ++i) {
      const BevPeak candidate = BestShift<kFineReach>(&fine, peak.yaw_rad + i * kFineYawStep_rad, 1,
                                                      static_cast<int>(peak.x_m), static_cast<int>(peak.y_m));
      if (candidate.score > best.score) best = candidate;
    }
    refined.push_back(best);
  }
  KeepDistinct(&refined, static_cast<std::size_t>(most));
  return refined;
}

}  // namespace mapweld::merge
