// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/sequence_match.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tools/merge/line_sums.hpp"

namespace mapweld::merge {
namespace {

constexpr int kSuppress = 3;  // keyframes around a chosen match that are not chosen again

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

// What sums over lines of unrelated entries are like: those of speed 1 at scattered places.
Spread SpreadOfLines(const Likeness& likeness, const LineSums& lines, int length) {
  constexpr std::size_t kSample = 2048;
  constexpr double kLeast = Likeness::kUnit / 4.0;
  std::vector<int> sums;
  const int rows = likeness.rows - length + 1;
  const int reach = std::abs(lines.Shift(0, length - 1));
  const int cols = likeness.cols - reach;
  if (rows < 1 || cols < 1) return {0, kLeast};
  const std::size_t size = static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
  const int first_col = lines.Shift(0, length - 1) < 0 ? reach : 0;
  for (const std::size_t at : Scattered(size, kSample)) {
    const int row = static_cast<int>(at / static_cast<std::size_t>(cols));
    const int col = static_cast<int>(at % static_cast<std::size_t>(cols)) + first_col;
    int sum = 0;
    for (int i = 0; i < length; ++i) sum += likeness.row(row + i)[col + lines.Shift(0, i)];
    sums.push_back(sum);
  }
  return RobustSpread(std::move(sums), kLeast);
}

// The middle of the line with the least sum that ends at (row, col).
Match MiddleOf(const Likeness& likeness, const LineSums& lines, int row, int col, int length) {
  Match best;
  int least = std::numeric_limits<int>::max();
  for (int speed = 0; speed < static_cast<int>(kLineSpeeds.size()); ++speed) {
    const auto col_at = [&](int r) { return col - lines.Shift(speed, row) + lines.Shift(speed, r); };
    const int first = col_at(row - length + 1);
    if (first < 0 || first >= likeness.cols) continue;
    int sum = 0;
    for (int r = row - length + 1; r <= row; ++r) sum += likeness.row(r)[col_at(r)];
    if (sum >= least) continue;
    least = sum;
    best.a = row - length / 2;
    best.b = col_at(best.a);
  }
  return best;
}

void MatchLength(const Likeness& likeness, int length, bool reverse, double min_score, std::vector<Match>* found) {
  LineSums lines(likeness.cols, length, 1, reverse);
  const Spread usual = SpreadOfLines(likeness, lines, length);
  const double limit = std::max(0.0, usual.median - min_score * usual.sigma);
  for (int row = 0; row < likeness.rows; ++row) {
    if (lines.Add(likeness.row(row)) > limit) continue;
    for (int col = 0; col < likeness.cols; ++col) {
      const int sum = lines.least()[static_cast<std::size_t>(col)];
      if (sum > limit) continue;
      Match match = MiddleOf(likeness, lines, row, col, length);
      match.score = (usual.median - sum) / usual.sigma;
      match.sequence = true;
      match.reverse = reverse;
      found->push_back(match);
    }
  }
}

}  // namespace

std::vector<Match> MatchSequences(const Likeness& likeness, const AssociationConfig& config) {
  std::vector<Match> found;
  for (const bool reverse : {false, true}) {
    for (int length = config.min_sequence; length <= config.max_sequence; length *= 2) {
      MatchLength(likeness, length, reverse, config.min_sequence_score, &found);
    }
  }
  return SuppressNeighbours(std::move(found), config.max_sequence_matches);
}

std::vector<Match> MatchSingles(const Likeness& likeness, const AssociationConfig& config) {
  // Second least of every row and column.
  struct Two {
    std::uint8_t first = 255;
    std::uint8_t second = 255;
    void Add(std::uint8_t d) {
      if (d >= second) return;
      second = std::max(first, d);
      first = std::min(first, d);
    }
  };
  const int limit = Likeness::kZero - static_cast<int>(std::ceil(config.min_single_score * Likeness::kUnit));
  std::vector<Two> of_row(static_cast<std::size_t>(likeness.rows));
  std::vector<Two> of_col(static_cast<std::size_t>(likeness.cols));
  std::vector<std::pair<int, int>> alike;
  for (int row = 0; row < likeness.rows; ++row) {
    for (int col = 0; col < likeness.cols; ++col) {
      const std::uint8_t d = likeness.row(row)[col];
      if (d > limit) continue;
      of_row[static_cast<std::size_t>(row)].Add(d);
      of_col[static_cast<std::size_t>(col)].Add(d);
      alike.emplace_back(row, col);
    }
  }
  std::vector<Match> found;
  for (const auto& [row, col] : alike) {
    const std::uint8_t d = likeness.row(row)[col];
    if (d > of_row[static_cast<std::size_t>(row)].second || d > of_col[static_cast<std::size_t>(col)].second) continue;
    found.push_back({row, col, likeness.Score(row, col), false, false, false});
  }
  return SuppressNeighbours(std::move(found), config.max_single_matches);
}

Evidence BestEvidence(const Likeness& likeness, int length, int row_step) {
  Evidence out;
  std::uint8_t least = Likeness::kZero;
  for (const std::uint8_t d : likeness.d) least = std::min(least, d);
  out.single = static_cast<double>(Likeness::kZero - least) / Likeness::kUnit;
  for (const bool reverse : {false, true}) {
    LineSums lines(likeness.cols, length, row_step, reverse);
    const Spread usual = SpreadOfLines(likeness, lines, length);
    int best = LineSums::kNoLine;
    for (int row = 0; row < likeness.rows; ++row) best = std::min<int>(best, lines.Add(likeness.row(row)));
    if (best != LineSums::kNoLine) out.sequence = std::max(out.sequence, (usual.median - best) / usual.sigma);
  }
  return out;
}

}  // namespace mapweld::merge
