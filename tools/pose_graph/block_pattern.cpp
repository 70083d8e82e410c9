// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_graph/block_pattern.hpp"

#include <algorithm>

#include "core/base/assert.hpp"
#include "tools/pose_graph/elimination_order.hpp"

namespace mapweld::pose_graph {

std::size_t BlockPattern::BlockAt(int row, int column) const {
  const auto from = rows.begin() + static_cast<std::ptrdiff_t>(begin[static_cast<std::size_t>(column)]);
  const auto to = rows.begin() + static_cast<std::ptrdiff_t>(begin[static_cast<std::size_t>(column) + 1]);
  const auto at = std::lower_bound(from, to, row);
  MAPWELD_ASSERT(at != to && *at == row);
  return static_cast<std::size_t>(at - rows.begin());
}

BlockPattern AnalyzePattern(int n, const std::vector<std::pair<int, int>>& ties) {
  const auto size = static_cast<std::size_t>(n);
  BlockPattern out;
  const std::vector<int> order = EliminationOrder(n, ties);
  out.position.resize(size);
  for (int k = 0; k < n; ++k) out.position[static_cast<std::size_t>(order[static_cast<std::size_t>(k)])] = k;

  // Ties by the column of the node that goes first.
  std::vector<std::size_t> tie_begin(size + 1, 0);
  std::vector<int> tie_row(ties.size());
  const auto column_and_row = [&](const std::pair<int, int>& tie) {
    return std::minmax(out.position[static_cast<std::size_t>(tie.first)],
                       out.position[static_cast<std::size_t>(tie.second)]);
  };
  for (const auto& tie : ties) ++tie_begin[static_cast<std::size_t>(column_and_row(tie).first) + 1];
  for (std::size_t k = 0; k < size; ++k) tie_begin[k + 1] += tie_begin[k];
  std::vector<std::size_t> fill = tie_begin;
  for (const auto& tie : ties) {
    const std::pair<int, int> at = column_and_row(tie);
    tie_row[fill[static_cast<std::size_t>(at.first)]++] = at.second;
  }

  // A column inherits the rows of every column whose first row it is (its children in the elimination tree).
  std::vector<int> first_child(size, -1);
  std::vector<int> next_child(size, -1);
  std::vector<int> seen_by(size, -1);
  out.begin.assign(1, 0);
  for (int k = 0; k < n; ++k) {
    const auto column = static_cast<std::size_t>(k);
    const std::size_t from = out.rows.size();
    seen_by[column] = k;
    const auto add = [&](int row) {
      int& seen = seen_by[static_cast<std::size_t>(row)];
      if (seen == k) return;
      seen = k;
      out.rows.push_back(row);
    };
    for (std::size_t i = tie_begin[column]; i < tie_begin[column + 1]; ++i) add(tie_row[i]);
    for (int child = first_child[column]; child >= 0; child = next_child[static_cast<std::size_t>(child)]) {
      for (std::size_t i = out.begin[static_cast<std::size_t>(child)] + 1;
           i < out.begin[static_cast<std::size_t>(child) + 1]; ++i) {
        add(out.rows[i]);
      }
    }
    std::sort(out.rows.begin() + static_cast<std::ptrdiff_t>(from), out.rows.end());
    out.begin.push_back(out.rows.size());
    if (out.rows.size() > from) {
      const auto parent = static_cast<std::size_t>(out.rows[from]);
      next_child[column] = first_child[parent];
      first_child[parent] = k;
    }
  }
  return out;
}

}  // namespace mapweld::pose_graph
