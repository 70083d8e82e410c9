// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/sequence_match.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace mapweld::merge {
namespace {

constexpr std::array<double, 5> kSlopes = {1.0, 0.9, 1.1, 0.8, 1.25};
constexpr int kSuppress = 3;  // keyframes around a chosen match that are not chosen again
constexpr float kMadToSigma = 1.4826F;

float Median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Median and robust standard deviation of those that are numbers. Large matrices are sampled: the error of both is
// then below a hundredth of the deviation.
std::pair<float, float> Spread(const std::vector<float>& values) {
  constexpr std::size_t kSample = 20000;
  std::vector<float> sample;
  const std::size_t n = values.size();
  for (std::size_t i = 0; i < std::min(n, kSample); ++i) {
    // Spread over all by the golden ratio; a fixed stride could meet the same columns in every row.
    const float value = values[n <= kSample ? i : i * 2654435769U % n];
    if (!std::isnan(value)) sample.push_back(value);
  }
  const float median = Median(sample);
  for (float& v : sample) v = std::abs(v - median);
  return {median, std::max(1e-6F, kMadToSigma * Median(std::move(sample)))};
}

bool ByScore(const Match& x, const Match& y) {
  if (x.score != y.score) return x.score > y.score;
  if (x.a != y.a) return x.a < y.a;
  return x.b != y.b ? x.b < y.b : x.reverse < y.reverse;
}

std::vector<Match> SuppressNeighbours(std::vector<Match> matches, int most) {
  std::sort(matches.begin(), matches.end(), ByScore);
  std::vector<Match> kept;
  for (const Match& match : matches) {
    if (static_cast<int>(kept.size()) == most) break;
    const bool is_near = std::any_of(kept.begin(), kept.end(), [&](const Match& other) {
      return std::abs(match.a - other.a) <= kSuppress && std::abs(match.b - other.b) <= kSuppress;
    });
    if (!is_near) kept.push_back(match);
  }
  return kept;
}

// Sums of one bundle of parallel lines: line `offset` holds the entries (row, offset + round(slope * row)).
class LineSums {
 public:
  LineSums(const Likeness& likeness, double slope) : rows_(likeness.rows), cols_(likeness.cols) {
    for (int row = 0; row < rows_; ++row) shift_.push_back(static_cast<int>(std::lround(slope * row)));
    const int extreme = shift_.empty() ? 0 : shift_.back();
    first_offset_ = std::min(0, -extreme);
    lines_ = cols_ + std::abs(extreme);
    sums_.assign(static_cast<std::size_t>(lines_) * static_cast<std::size_t>(rows_ + 1), 0.0);
    for (int line = 0; line < lines_; ++line) {
      double* sum = Line(line);
      for (int row = 0; row < rows_; ++row) {
        const int col = line + first_offset_ + shift_[static_cast<std::size_t>(row)];
        const bool inside = col >= 0 && col < cols_;
        sum[row + 1] = sum[row] + (inside ? static_cast<double>(likeness.at(row, col)) : 0.0);
      }
    }
  }

  // Mean times square root of the length, over the `length` rows around `row` on the line through (row, col); fewer at
  // the border. NaN when fewer than min_length remain.
  [[nodiscard]] float Score(int row, int col, int length, int min_length) const {
    const int offset = col - shift_[static_cast<std::size_t>(row)];
    int begin = std::max(0, row - length / 2);
    int end = std::min(rows_, row - length / 2 + length);
    while (begin < end && !Inside(begin, offset)) ++begin;
    while (begin < end && !Inside(end - 1, offset)) --end;
    if (end - begin < min_length) return std::numeric_limits<float>::quiet_NaN();
    const double* sum = Line(offset - first_offset_);
    return static_cast<float>((sum[end] - sum[begin]) / std::sqrt(static_cast<double>(end - begin)));
  }

 private:
  [[nodiscard]] bool Inside(int row, int offset) const {
    const int col = offset + shift_[static_cast<std::size_t>(row)];
    return col >= 0 && col < cols_;
  }
  double* Line(int line) { return sums_.data() + static_cast<std::ptrdiff_t>(line) * (rows_ + 1); }
  [[nodiscard]] const double* Line(int line) const {
    return sums_.data() + static_cast<std::ptrdiff_t>(line) * (rows_ + 1);
  }

  int rows_;
  int cols_;
  int first_offset_ = 0;
  int lines_ = 0;
  std::vector<int> shift_;
  std::vector<double> sums_;
};

}  // namespace

Likeness ComputeLikeness(const Distances& distances) {
  Likeness out{distances.rows, distances.cols, std::vector<float>(distances.d.size(), 0)};
  if (distances.d.empty()) return out;
  std::vector<float> row_median;
  std::vector<float> col_median;
  for (int row = 0; row < out.rows; ++row) {
    const auto begin = distances.d.begin() + static_cast<std::ptrdiff_t>(row) * out.cols;
    row_median.push_back(Median({begin, begin + out.cols}));
  }
  for (int col = 0; col < out.cols; ++col) {
    std::vector<float> column;
    for (int row = 0; row < out.rows; ++row) column.push_back(distances.at(row, col));
    col_median.push_back(Median(std::move(column)));
  }
  for (int row = 0; row < out.rows; ++row) {
    for (int col = 0; col < out.cols; ++col) {
      const auto i = static_cast<std::size_t>(row);
      const auto j = static_cast<std::size_t>(col);
      out.z[i * static_cast<std::size_t>(out.cols) + j] =
          0.5F * (row_median[i] + col_median[j]) - distances.at(row, col);
    }
  }
  const auto [median, sigma] = Spread(out.z);
  for (float& z : out.z) z = (z - median) / sigma;
  return out;
}

std::vector<Match> MatchSequences(const Likeness& likeness, const AssociationConfig& config) {
  std::vector<Match> found;
  for (const bool reverse : {false, true}) {
    std::vector<float> best(likeness.z.size(), -std::numeric_limits<float>::infinity());
    for (const double slope : kSlopes) {
      const LineSums lines(likeness, reverse ? -slope : slope);
      for (int length = config.min_sequence; length <= config.max_sequence; length *= 2) {
        std::vector<float> scores(likeness.z.size());
        for (int row = 0; row < likeness.rows; ++row) {
          for (int col = 0; col < likeness.cols; ++col) {
            const auto at =
                static_cast<std::size_t>(row) * static_cast<std::size_t>(likeness.cols) + static_cast<std::size_t>(col);
            scores[at] = lines.Score(row, col, length, config.min_sequence);
          }
        }
        const auto [median, sigma] = Spread(scores);
        for (std::size_t i = 0; i < scores.size(); ++i) {
          if (!std::isnan(scores[i])) best[i] = std::max(best[i], (scores[i] - median) / sigma);
        }
      }
    }
    for (int row = 0; row < likeness.rows; ++row) {
      for (int col = 0; col < likeness.cols; ++col) {
        const auto at =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(likeness.cols) + static_cast<std::size_t>(col);
        const auto score = static_cast<double>(best[at]);
        if (score >= config.min_sequence_score) found.push_back({row, col, score, true, reverse, false});
      }
    }
  }
  return SuppressNeighbours(std::move(found), config.max_sequence_matches);
}

std::vector<Match> MatchSingles(const Likeness& likeness, const AssociationConfig& config) {
  std::vector<float> row_second(static_cast<std::size_t>(likeness.rows));
  std::vector<float> col_second(static_cast<std::size_t>(likeness.cols));
  const auto second_best = [](std::vector<float> values) {
    const std::size_t n = std::min<std::size_t>(2, values.size());
    std::partial_sort(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), values.end(), std::greater<>());
    return values[n - 1];
  };
  if (likeness.z.empty()) return {};
  for (int row = 0; row < likeness.rows; ++row) {
    const auto begin = likeness.z.begin() + static_cast<std::ptrdiff_t>(row) * likeness.cols;
    row_second[static_cast<std::size_t>(row)] = second_best({begin, begin + likeness.cols});
  }
  for (int col = 0; col < likeness.cols; ++col) {
    std::vector<float> column;
    for (int row = 0; row < likeness.rows; ++row) column.push_back(likeness.at(row, col));
    col_second[static_cast<std::size_t>(col)] = second_best(std::move(column));
  }
  std::vector<Match> found;
  for (int row = 0; row < likeness.rows; ++row) {
    for (int col = 0; col < likeness.cols; ++col) {
      const float z = likeness.at(row, col);
      if (static_cast<double>(z) < config.min_single_score) continue;
      if (z < row_second[static_cast<std::size_t>(row)] || z < col_second[static_cast<std::size_t>(col)]) continue;
      found.push_back({row, col, static_cast<double>(z), false, false, false});
    }
  }
  return SuppressNeighbours(std::move(found), config.max_single_matches);
}

}  // namespace mapweld::merge
