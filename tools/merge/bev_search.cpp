// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/bev_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mapweld::merge {
namespace {

constexpr int kCoarseYaws = 72;
constexpr double kFineYawStep_rad = 0.03;
constexpr int kFineYaws = 2;      // steps to each side
constexpr int kFineReach = 3;     // m to each side
constexpr int kCoarseReach = 12;  // cells of 2 m to each side

constexpr std::int32_t kCount = 1024;  // more than BevImage::kStrongest

struct TurnedCell {
  int x, y;
};

// Sums of a's contrast under the strongest cells of b, and how many of those cells a has seen, for many shifts at once.
class Correlator {
 public:
  Correlator(const std::vector<std::int8_t>& contrast_of_a, const PreparedSubmap& b, int size, int max_shift)
      : b_(&b), size_(size), margin_(max_shift + 1), taken_(contrast_of_a.size()) {
    const int stride = size_ + 2 * margin_;
    a_.assign(static_cast<std::size_t>(stride * stride), 0);
    double energy = 0;
    int seen = 0;
    for (int x = 0; x < size_; ++x) {
      for (int y = 0; y < size_; ++y) {
        const std::int32_t value = contrast_of_a[static_cast<std::size_t>(x * size_ + y)];
        if (value == BevImage::kUnseen) continue;
        a_[static_cast<std::size_t>((x + margin_) * stride + y + margin_)] = value * kCount + 1;
        energy += value * value;
        ++seen;
      }
    }
    deviation_ = std::max(1e-3, std::sqrt(energy / std::max(1, seen)));
  }

  // For every shift within kReach cells of (shift_x, shift_y); row-major, rows = x. The margin makes tests at the
  // border needless.
  template <int kReach>
  void Correlate(double yaw_rad, int shift_x, int shift_y, std::vector<std::int32_t>* sums) {
    Turn(yaw_rad);
    constexpr int kSide = 2 * kReach + 1;
    sums->assign(static_cast<std::size_t>(kSide * kSide), 0);
    const int stride = size_ + 2 * margin_;
    for (const TurnedCell& cell : turned_) {
      std::int32_t* to = sums->data();
      const std::int32_t* from =
          a_.data() + (cell.x + shift_x - kReach + margin_) * stride + (cell.y + shift_y - kReach + margin_);
      for (int dx = 0; dx < kSide; ++dx, to += kSide, from += stride) {
        for (int dy = 0; dy < kSide; ++dy) to[dy] += from[dy];
      }
    }
  }

  // Of one sum of the last Correlate: the mean contrast in standard deviations, times the root of the share of b that a
  // has seen, since the mean over a few cells is high by chance.
  [[nodiscard]] double Score(std::int32_t sum) const {
    const std::int32_t seen = sum & (kCount - 1);
    const std::int32_t contrast = (sum - seen) / kCount;
    if (contrast <= 0) return 0;
    return contrast / (deviation_ * std::sqrt(static_cast<double>(seen) * static_cast<double>(turned_.size())));
  }

 private:
  // The strongest cells of b turned by yaw; one entry per cell of the image.
  void Turn(double yaw_rad) {
    std::fill(taken_.begin(), taken_.end(), false);
    turned_.clear();
    const auto c = static_cast<float>(std::cos(yaw_rad));
    const auto s = static_cast<float>(std::sin(yaw_rad));
    const auto scale = static_cast<float>(size_) / (2 * PreparedSubmap::kHalfSize_m);
    for (const Eigen::Vector2f& p : b_->bev().strongest) {
      const int x = static_cast<int>(std::floor((c * p.x() - s * p.y() + PreparedSubmap::kHalfSize_m) * scale));
      const int y = static_cast<int>(std::floor((s * p.x() + c * p.y() + PreparedSubmap::kHalfSize_m) * scale));
      if (x < 0 || y < 0 || x >= size_ || y >= size_) continue;
      const auto at = static_cast<std::size_t>(x * size_ + y);
      if (!taken_[at]) turned_.push_back({x, y});
      taken_[at] = true;
    }
  }

  const PreparedSubmap* b_;
  int size_;
  int margin_;
  // Contrast in the upper bits, 1 where seen in the lower: one addition sums both. With a margin of zeros.
  std::vector<std::int32_t> a_;
  double deviation_ = 1;
  std::vector<bool> taken_;
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
  std::vector<std::int32_t> sums;
  correlator->Correlate<kReach>(yaw_rad, shift_x, shift_y, &sums);
  int at = 0;
  double best = -1;
  for (int i = 0; i < static_cast<int>(sums.size()); ++i) {
    const double score = correlator->Score(sums[static_cast<std::size_t>(i)]);
    if (score <= best) continue;
    best = score;
    at = i;
  }
  constexpr int kSide = 2 * kReach + 1;
  BevPeak peak;
  peak.x_m = (at / kSide - kReach + shift_x) * cell_m;
  peak.y_m = (at % kSide - kReach + shift_y) * cell_m;
  peak.yaw_rad = yaw_rad;
  peak.score = best;
  return peak;
}

}  // namespace

std::vector<BevPeak> SearchBev(const PreparedSubmap& a, const PreparedSubmap& b, int most) {
  Correlator coarse(a.bev().coarse_contrast, b, BevImage::kCoarse, kCoarseReach);
  std::vector<BevPeak> peaks;
  for (int i = 0; i < kCoarseYaws; ++i) {
    peaks.push_back(BestShift<kCoarseReach>(&coarse, 2 * std::numbers::pi * i / kCoarseYaws, 2, 0, 0));
  }
  KeepDistinct(&peaks, static_cast<std::size_t>(2 * most));

  Correlator fine(a.bev().fine_contrast, b, BevImage::kFine, 2 * kCoarseReach + kFineReach);
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
