// SPDX-License-Identifier: Apache-2.0
// The streets as a graph and shortest paths on it. One-way rules are ignored: a survey vehicle drives where it is sent.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tools/sim/town.hpp"

namespace mapweld::sim {

class RoadGraph {
 public:
  // Long straight edges are cut so that a waypoint can lie anywhere along a street.
  static constexpr double kMaxEdge_m = 5.0;

  struct Edge {
    std::uint32_t to;
    double length_m;
  };
  // May a path go from one node to the next?
  using Permit = std::function<bool(std::uint32_t from, std::uint32_t to)>;

  explicit RoadGraph(const std::vector<Road>& roads);
  [[nodiscard]] std::uint32_t NearestNode(const Vec2d& p) const;  // O(nodes)
  [[nodiscard]] const Vec2d& Position(std::uint32_t node) const { return positions_[node]; }
  [[nodiscard]] const std::vector<Edge>& Edges(std::uint32_t node) const { return edges_[node]; }
  // Nodes from `from` to `to`, both included; empty when no permitted street connects them. Dijkstra; ties go to the
  // lower index.
  [[nodiscard]] std::vector<std::uint32_t> ShortestPath(
      std::uint32_t from, std::uint32_t to,
      const Permit& permit = [](std::uint32_t, std::uint32_t) { return true; }) const;
  [[nodiscard]] std::size_t size() const { return positions_.size(); }

 private:
  void Connect(std::uint32_t a, std::uint32_t b);
  std::vector<Vec2d> positions_;
  std::vector<std::vector<Edge>> edges_;
};

}  // namespace mapweld::sim
