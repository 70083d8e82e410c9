// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/road_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <unordered_map>
#include <utility>

namespace mapweld::sim {

RoadGraph::RoadGraph(const std::vector<Road>& roads) {
  std::unordered_map<std::int64_t, std::uint32_t> index_of;
  const auto add = [this](const Vec2d& p) {
    positions_.push_back(p);
    edges_.emplace_back();
    return static_cast<std::uint32_t>(positions_.size() - 1);
  };
  for (const Road& road : roads) {
    if (!road.street) continue;
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < road.nodes.size(); ++i) {
      const auto [found, fresh] = index_of.try_emplace(road.nodes[i], 0);
      if (fresh) found->second = add(road.line[i]);
      if (i > 0) {
        const Vec2d step = road.line[i] - road.line[i - 1];
        const auto pieces = static_cast<int>(std::ceil(std::max(step.norm(), 1e-3) / kMaxEdge_m));
        for (int k = 1; k < pieces; ++k) {
          const std::uint32_t mid = add(road.line[i - 1] + step * (static_cast<double>(k) / pieces));
          Connect(before, mid);
          before = mid;
        }
        Connect(before, found->second);
      }
      before = found->second;
    }
  }
}

void RoadGraph::Connect(std::uint32_t a, std::uint32_t b) {
  const double length = (positions_[a] - positions_[b]).norm();
  edges_[a].push_back({b, length});
  edges_[b].push_back({a, length});
}

std::uint32_t RoadGraph::NearestNode(const Vec2d& p) const {
  const auto nearest = std::min_element(positions_.begin(), positions_.end(), [&](const Vec2d& a, const Vec2d& b) {
    return (a - p).squaredNorm() < (b - p).squaredNorm();
  });
  return static_cast<std::uint32_t>(nearest - positions_.begin());
}

std::vector<std::uint32_t> RoadGraph::ShortestPath(std::uint32_t from, std::uint32_t to, const Permit& permit) const {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<double> distance(size(), std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> parent(size(), kNone);
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  distance[from] = 0;
  open.emplace(0.0, from);
  while (!open.empty() && open.top().second != to) {
    const auto [d, node] = open.top();
    open.pop();
    if (d > distance[node]) continue;
    for (const Edge& e : edges_[node]) {
      if (d + e.length_m >= distance[e.to] || !permit(node, e.to)) continue;
      distance[e.to] = d + e.length_m;
      parent[e.to] = node;
      open.emplace(distance[e.to], e.to);
    }
  }
  if (from != to && parent[to] == kNone) return {};
  std::vector<std::uint32_t> path{to};
  while (path.back() != from) path.push_back(parent[path.back()]);
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace mapweld::sim
