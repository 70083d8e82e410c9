// SPDX-License-Identifier: Apache-2.0
// Lines of low distance in a difference matrix: SeqSLAM (Milford, Wyeth, ICRA 2012) with running sums, so that the cost
// does not grow with the length of the sequence.
#pragma once

#include <vector>

#include "tools/merge/difference.hpp"
#include "tools/merge/merge_config.hpp"

namespace mapweld::merge {

// Distances made comparable: each entry against its row and its column (a keyframe that resembles everything says
// nothing), in units of the matrix's own robust standard deviation. Positive = more alike than usual.
struct Likeness {
  int rows = 0;
  int cols = 0;
  std::vector<float> z;  // row-major
  [[nodiscard]] float at(int row, int col) const {
    return z[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col)];
  }
};

Likeness ComputeLikeness(const Distances& distances);

// One candidate: keyframe a of the first drive at the place of keyframe b of the second.
struct Match {
  int a = 0;
  int b = 0;
  double score = 0;       // robust standard deviations above unrelated entries or lines
  bool sequence = false;  // found as part of a line, not alone
  bool reverse = false;   // the line runs backwards in b
  bool ends = false;      // a meeting of the drives' ends, tried whatever it looks like
};

// The middles of the best lines, best first; lines that end at the border of the matrix may be short down to
// min_sequence. Slopes 0.8 to 1.25 and their negatives. Cost: about 50 additions per entry.
std::vector<Match> MatchSequences(const Likeness& likeness, const AssociationConfig& config);

// Entries that are among the two best of their row and of their column, best first.
std::vector<Match> MatchSingles(const Likeness& likeness, const AssociationConfig& config);

}  // namespace mapweld::merge
