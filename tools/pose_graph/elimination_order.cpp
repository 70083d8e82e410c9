// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_graph/elimination_order.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

namespace mapweld::pose_graph {
namespace {

using Neighbours = std::vector<std::vector<int>>;

void Remove(std::vector<int>* list, int node) {
  list->erase(std::find(list->begin(), list->end(), node));
}

// Takes nodes with at most two neighbours until none is left.
void PeelChains(Neighbours* neighbours, std::vector<bool>* gone, std::vector<int>* order) {
  const auto of = [&](int node) -> std::vector<int>& { return (*neighbours)[static_cast<std::size_t>(node)]; };
  const auto small = [&](int node) { return of(node).size() <= 2; };
  const int n = static_cast<int>(neighbours->size());
  std::vector<int> next;
  for (int first = 0; first < n; ++first) {
    // Along the chain, so that what is used together lies together.
    next.assign(1, first);
    while (!next.empty()) {
      const int node = next.back();
      next.pop_back();
      if ((*gone)[static_cast<std::size_t>(node)] || !small(node)) continue;
      (*gone)[static_cast<std::size_t>(node)] = true;
      order->push_back(node);
      const std::vector<int> ends = of(node);
      for (const int end : ends) Remove(&of(end), node);
      if (ends.size() == 2 && std::find(of(ends[0]).begin(), of(ends[0]).end(), ends[1]) == of(ends[0]).end()) {
        of(ends[0]).push_back(ends[1]);
        of(ends[1]).push_back(ends[0]);
      }
      for (const int end : ends) {
        if (end < first && small(end)) next.push_back(end);  // others have their turn
      }
    }
  }
}

// Approximate minimum degree on the nodes that are left.
void OrderRest(const Neighbours& neighbours, const std::vector<bool>& gone, std::vector<int>* order) {
  std::vector<int> rest;
  std::vector<int> index(neighbours.size(), -1);
  for (std::size_t i = 0; i < gone.size(); ++i) {
    if (gone[i]) continue;
    index[i] = static_cast<int>(rest.size());
    rest.push_back(static_cast<int>(i));
  }
  if (rest.empty()) return;
  std::vector<Eigen::Triplet<double, int>> entries;
  for (const int node : rest) {
    const int row = index[static_cast<std::size_t>(node)];
    entries.emplace_back(row, row, 1.0);
    for (const int other : neighbours[static_cast<std::size_t>(node)]) {
      entries.emplace_back(row, index[static_cast<std::size_t>(other)], 1.0);
    }
  }
  const auto n = static_cast<Eigen::Index>(rest.size());
  Eigen::SparseMatrix<double> pattern(n, n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(pattern, permutation);
  for (Eigen::Index k = 0; k < n; ++k) {
    order->push_back(rest[static_cast<std::size_t>(permutation.indices()(k))]);
  }
}

}  // namespace

std::vector<int> EliminationOrder(int n, const std::vector<std::pair<int, int>>& ties) {
  Neighbours neighbours(static_cast<std::size_t>(n));
  for (const auto& [a, b] : ties) {
    neighbours[static_cast<std::size_t>(a)].push_back(b);
    neighbours[static_cast<std::size_t>(b)].push_back(a);
  }
  std::vector<bool> gone(static_cast<std::size_t>(n), false);
  std::vector<int> order;
  order.reserve(static_cast<std::size_t>(n));
  PeelChains(&neighbours, &gone, &order);
  OrderRest(neighbours, gone, &order);
  return order;
}

}  // namespace mapweld::pose_graph
