// SPDX-License-Identifier: Apache-2.0
// Where the blocks of a sparse Cholesky factor are: found once, used for every factorisation and every block size.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace mapweld::pose_graph {

// Column k belongs to the node that is eliminated k-th. Below its diagonal block it has blocks in rows(k), ascending.
struct BlockPattern {
  std::vector<int> position;       // of a node in the order of elimination
  std::vector<std::size_t> begin;  // per column, of its blocks; one more entry for the end
  std::vector<int> rows;           // per block

  [[nodiscard]] int columns() const { return static_cast<int>(position.size()); }
  // The block in (row, column), both positions, row > column. It must exist.
  [[nodiscard]] std::size_t BlockAt(int row, int column) const;
};

// `ties`: pairs of different nodes 0..n-1, each at most once, in any order. Chains of a city graph add no fill.
// Cost: linear in the blocks of the factor, plus the ordering.
BlockPattern AnalyzePattern(int n, const std::vector<std::pair<int, int>>& ties);

}  // namespace mapweld::pose_graph
