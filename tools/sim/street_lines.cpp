// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/street_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <utility>

namespace mapweld::sim {
namespace {

constexpr double kCell_m = 0.5;
constexpr double kShortestDeadEnd_m = 12;
constexpr double kNode_m = 4;         // between the points of a line
constexpr double kOneJunction_m = 6;  // junctions this near to each other are one
constexpr double kWidestSquare_m = 200;

// Cells about the areas' box, with an empty margin so that every set cell has eight neighbours.
class Raster {
 public:
  explicit Raster(const std::vector<Area>& areas) {
    Box2 box;
    for (const Area& area : areas) {
      for (const Polyline& ring : area) {
        for (const Vec2d& p : ring) box.Extend(p);
      }
    }
    if (box.low.x() > box.high.x()) return;
    low_ = box.low - Vec2d::Constant(2 * kCell_m);
    const Vec2d cells = ((box.high - low_) / kCell_m).array().ceil() + 3;
    if (cells.x() * cells.y() > 1e8) {
      throw std::runtime_error(fmt::format("its streets reach over {:.0f} x {:.0f} m; cut out less than 25 km^2",
                                           cells.x() * kCell_m, cells.y() * kCell_m));
    }
    columns_ = static_cast<int>(cells.x());
    rows_ = static_cast<int>(cells.y());
    set_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
    for (const Area& area : areas) Fill(area);
  }

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] std::size_t size() const { return set_.size(); }
  [[nodiscard]] bool operator[](int cell) const { return set_[static_cast<std::size_t>(cell)] != 0; }
  void Clear(int cell) { set_[static_cast<std::size_t>(cell)] = 0; }
  [[nodiscard]] Vec2d Centre(int cell) const {
    return low_ + kCell_m * Vec2d(cell % columns_ + 0.5, static_cast<double>(cell / columns_) + 0.5);
  }
  // Round the cell, beginning north, clockwise.
  [[nodiscard]] std::array<int, 8> Neighbours(int cell) const {
    const int c = columns_;
    return {cell + c, cell + c + 1, cell + 1, cell - c + 1, cell - c, cell - c - 1, cell - 1, cell + c - 1};
  }
  [[nodiscard]] std::vector<int> SetCells() const {
    std::vector<int> cells;
    for (std::size_t i = 0; i < set_.size(); ++i) {
      if (set_[i] != 0) cells.push_back(static_cast<int>(i));
    }
    return cells;
  }
  // How often the ring of neighbours goes from empty to set.
  [[nodiscard]] int Transitions(int cell) const {
    const std::array<int, 8> ring = Neighbours(cell);
    int transitions = 0;
    for (std::size_t i = 0; i < 8; ++i) transitions += !(*this)[ring[i]] && (*this)[ring[(i + 1) % 8]] ? 1 : 0;
    return transitions;
  }
  // In how many parts the neighbours would fall without the cell, when cells hang together by their corners: 1 at an
  // end, 2 along a line, more at a junction.
  [[nodiscard]] int Branches(int cell) const {
    const std::array<int, 8> ring = Neighbours(cell);
    const auto set = [&](std::size_t i) { return (*this)[ring[i % 8]]; };
    int branches = 0;
    for (std::size_t i = 0; i < 8; i += 2) branches += !set(i) && (set(i + 1) || set(i + 2)) ? 1 : 0;
    const bool middle_of_a_cross = set(0) && set(2) && set(4) && set(6);
    return middle_of_a_cross ? 4 : branches;
  }
  // Traffic islands, and gaps in the drawing: what is empty, enclosed, and smaller than so many cells.
  void FillHoles(std::size_t cells) {
    std::vector<char> seen(set_.size(), 0);
    for (std::size_t seed = 0; seed < set_.size(); ++seed) {
      if (set_[seed] != 0 || seen[seed] != 0) continue;
      std::vector<std::uint32_t> hole{static_cast<std::uint32_t>(seed)};
      seen[seed] = 1;
      const auto offer = [&](std::size_t cell) {
        if (set_[cell] != 0 || seen[cell] != 0) return;
        seen[cell] = 1;
        hole.push_back(static_cast<std::uint32_t>(cell));
      };
      const auto columns = static_cast<std::size_t>(columns_);
      for (std::size_t i = 0; i < hole.size(); ++i) {
        const std::size_t cell = hole[i];
        if (cell % columns > 0) offer(cell - 1);
        if (cell % columns + 1 < columns) offer(cell + 1);
        if (cell >= columns) offer(cell - columns);
        if (cell + columns < set_.size()) offer(cell + columns);
      }
      if (hole.size() > cells) continue;
      for (const std::size_t cell : hole) set_[cell] = 1;
    }
  }

 private:
  void Fill(const Area& area) {
    Box2 box;
    for (const Polyline& ring : area) {
      for (const Vec2d& p : ring) box.Extend(p);
    }
    if (box.low.x() > box.high.x()) return;
    const auto row_of = [&](double y) { return static_cast<int>((y - low_.y()) / kCell_m); };
    for (int row = row_of(box.low.y()); row <= row_of(box.high.y()); ++row) {
      const double y = low_.y() + (row + 0.5) * kCell_m;
      std::vector<double> crossings;
      for (const Polyline& ring : area) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const Vec2d& a = ring[i];
          const Vec2d& b = ring[(i + 1) % ring.size()];
          if ((a.y() <= y) == (b.y() <= y)) continue;
          crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
        }
      }
      std::sort(crossings.begin(), crossings.end());
      for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
        const auto first = static_cast<int>(std::ceil((crossings[i] - low_.x()) / kCell_m - 0.5));
        const auto last = static_cast<int>(std::floor((crossings[i + 1] - low_.x()) / kCell_m - 0.5));
        for (int column = first; column <= last; ++column) set_[static_cast<std::size_t>(row * columns_ + column)] = 1;
      }
    }
  }

  Vec2d low_ = Vec2d::Zero();
  int columns_ = 0;
  int rows_ = 0;
  std::vector<char> set_;
};

// Distance of every set cell to the nearest empty one, in metres: two passes over a 3-4 chamfer mask.
std::vector<float> DistanceToEdge(const Raster& raster) {
  constexpr float kStraight = 1;
  constexpr float kDiagonal = 4.0F / 3;
  std::vector<float> distance(raster.size(), 0);
  const std::vector<int> cells = raster.SetCells();
  for (const int cell : cells) distance[static_cast<std::size_t>(cell)] = 1e9F;
  const auto relax = [&](int cell) {
    float& best = distance[static_cast<std::size_t>(cell)];
    const std::array<int, 8> ring = raster.Neighbours(cell);
    for (std::size_t i = 0; i < 8; ++i) {
      best = std::min(best, distance[static_cast<std::size_t>(ring[i])] + (i % 2 == 0 ? kStraight : kDiagonal));
    }
  };
  std::for_each(cells.begin(), cells.end(), relax);
  std::for_each(cells.rbegin(), cells.rend(), relax);
  for (float& d : distance) d *= static_cast<float>(kCell_m);
  return distance;
}

// Peels cells off until only lines are left, from two sides in turn so that they stay in the middle.
void Thin(Raster* raster) {
  std::vector<int> cells = raster->SetCells();
  for (bool changed = true; changed;) {
    changed = false;
    for (const int side : {0, 1}) {
      std::vector<int> peeled;
      for (const int cell : cells) {
        const std::array<int, 8> ring = raster->Neighbours(cell);
        const auto set = [&](std::size_t i) { return (*raster)[ring[i]]; };
        int count = 0;
        for (std::size_t i = 0; i < 8; ++i) count += set(i) ? 1 : 0;
        if (count < 2 || count > 6 || raster->Transitions(cell) != 1) continue;
        const bool north = set(0);
        const bool east = set(2);
        const bool south = set(4);
        const bool west = set(6);
        const bool kept = side == 0 ? (north && east && south) || (east && south && west)
                                    : (north && east && west) || (north && south && west);
        if (!kept) peeled.push_back(cell);
      }
      for (const int cell : peeled) raster->Clear(cell);
      changed = changed || !peeled.empty();
      std::erase_if(cells, [&](int cell) { return !(*raster)[cell]; });
    }
  }
  // That leaves diagonals two cells thick.
  for (const int cell : cells) {
    int count = 0;
    for (const int next : raster->Neighbours(cell)) count += (*raster)[next] ? 1 : 0;
    if (count >= 2 && raster->Branches(cell) == 1) raster->Clear(cell);
  }
}

// A line of cells between two junctions or ends, both included.
struct Chain {
  std::vector<int> cells;
  bool dead_end = false;
};

bool IsShort(const Chain& chain) {
  return static_cast<double>(chain.cells.size()) * kCell_m <= kOneJunction_m;
}

// All chains of a thinned raster; `junction` gets the group of each cell where three or more meet.
std::vector<Chain> TraceChains(const Raster& lines, std::map<int, int>* junction) {
  const std::vector<int> cells = lines.SetCells();
  junction->clear();
  int groups = 0;
  for (const int seed : cells) {
    if (lines.Branches(seed) < 3 || junction->contains(seed)) continue;
    std::vector<int> open{seed};
    (*junction)[seed] = groups;
    while (!open.empty()) {
      const int cell = open.back();
      open.pop_back();
      for (const int next : lines.Neighbours(cell)) {
        if (lines[next] && lines.Branches(next) >= 3 && junction->emplace(next, groups).second) open.push_back(next);
      }
    }
    ++groups;
  }
  std::vector<char> walked(lines.size(), 0);
  const auto walk = [&](int from, int first) {
    Chain chain{{from, first}, false};
    walked[static_cast<std::size_t>(first)] = 1;
    for (;;) {
      const int here = chain.cells.back();
      const int before = chain.cells[chain.cells.size() - 2];
      const std::array<int, 8> ring = lines.Neighbours(here);
      int next = -1;
      // Straight neighbours before diagonal ones, junctions before all.
      for (const std::size_t i : {0U, 2U, 4U, 6U, 1U, 3U, 5U, 7U}) {
        const int cell = ring[i];
        if (!lines[cell] || cell == before) continue;
        if (junction->contains(cell) &&
            (chain.cells.size() > 2 || !junction->contains(from) || junction->at(cell) != junction->at(from))) {
          chain.cells.push_back(cell);
          return chain;
        }
        if (next < 0 && walked[static_cast<std::size_t>(cell)] == 0 && !junction->contains(cell)) next = cell;
      }
      if (next < 0) {
        chain.dead_end = lines.Branches(here) == 1;
        return chain;
      }
      walked[static_cast<std::size_t>(next)] = 1;
      chain.cells.push_back(next);
    }
  };
  std::vector<Chain> chains;
  for (const auto& [cell, group] : *junction) {
    for (const int next : lines.Neighbours(cell)) {
      if (lines[next] && walked[static_cast<std::size_t>(next)] == 0 && !junction->contains(next)) {
        chains.push_back(walk(cell, next));
      }
    }
  }
  // Streets that meet no other: from an end to an end, or round.
  for (const bool ends : {true, false}) {
    for (const int cell : cells) {
      if (walked[static_cast<std::size_t>(cell)] != 0 || junction->contains(cell)) continue;
      if (ends && lines.Branches(cell) != 1) continue;
      walked[static_cast<std::size_t>(cell)] = 1;
      for (const int next : lines.Neighbours(cell)) {
        if (!lines[next] || walked[static_cast<std::size_t>(next)] != 0) continue;
        Chain chain = walk(cell, next);
        chain.dead_end = false;
        if (!ends) chain.cells.push_back(cell);
        chains.push_back(std::move(chain));
        break;
      }
    }
  }
  return chains;
}

// Without dead ends that only lead into the corner of a junction.
std::vector<Chain> TraceStreets(Raster* lines, std::map<int, int>* junction) {
  for (;;) {
    std::vector<Chain> chains = TraceChains(*lines, junction);
    bool pruned = false;
    for (const Chain& chain : chains) {
      if (!chain.dead_end || static_cast<double>(chain.cells.size()) * kCell_m >= kShortestDeadEnd_m) continue;
      for (std::size_t i = 1; i < chain.cells.size(); ++i) lines->Clear(chain.cells[i]);
      pruned = true;
    }
    if (!pruned) return chains;
  }
}

// The cells' stairs made smooth, its ends where they are.
Polyline Smooth(const Polyline& stairs) {
  constexpr std::ptrdiff_t kHalfWindow = 6;
  const auto n = static_cast<std::ptrdiff_t>(stairs.size());
  Polyline smooth;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const std::ptrdiff_t half = std::min({kHalfWindow, i, n - 1 - i});
    Vec2d sum = Vec2d::Zero();
    for (std::ptrdiff_t k = i - half; k <= i + half; ++k) sum += stairs[static_cast<std::size_t>(k)];
    smooth.emplace_back(sum / static_cast<double>(2 * half + 1));
  }
  return smooth;
}

// Which node of the streets a cell is, and where. Groups of junction cells that a short chain connects are one
// junction, in the middle of their cells.
class Junctions {
 public:
  Junctions(const Raster& raster, const std::map<int, int>& groups, const std::vector<Chain>& chains)
      : raster_(raster), group_(groups) {
    for (const Chain& chain : chains) {
      const auto from = group_.find(chain.cells.front());
      const auto to = group_.find(chain.cells.back());
      if (from == group_.end() || to == group_.end() || !IsShort(chain)) continue;
      const auto [low, high] = std::minmax({from->second, to->second});
      for (auto& [cell, group] : group_) group = group == high ? low : group;
    }
    for (const auto& [cell, group] : group_) {
      auto& [sum, count] = middle_.try_emplace(group, Vec2d::Zero(), 0).first->second;
      sum += raster_.Centre(cell);
      ++count;
    }
  }
  [[nodiscard]] std::int64_t Node(int cell) const {
    const auto found = group_.find(cell);
    return found == group_.end() ? 1'000'000'000 + static_cast<std::int64_t>(cell) : 1 + found->second;
  }
  [[nodiscard]] Vec2d Place(int cell) const {
    const auto found = group_.find(cell);
    if (found == group_.end()) return raster_.Centre(cell);
    const auto& [sum, count] = middle_.at(found->second);
    return sum / count;
  }

 private:
  const Raster& raster_;
  std::map<int, int> group_;
  std::map<int, std::pair<Vec2d, int>> middle_;
};

}  // namespace

std::vector<Road> StreetLines(const std::vector<Area>& carriageways) {
  constexpr double kNarrowest_m = 2.6;  // half a carriageway
  constexpr double kWidest_m = 7;
  constexpr double kIsland_m2 = 60;
  Raster raster(carriageways);
  raster.FillHoles(static_cast<std::size_t>(kIsland_m2 / (kCell_m * kCell_m)));
  const std::vector<float> to_edge = DistanceToEdge(raster);
  const auto widest = std::max_element(to_edge.begin(), to_edge.end());
  if (widest != to_edge.end() && static_cast<double>(*widest) > kWidestSquare_m / 2) {
    throw std::runtime_error(fmt::format("an area of its streets is wider than {} m: no street", kWidestSquare_m));
  }
  Thin(&raster);
  std::map<int, int> cells_of_junctions;
  const std::vector<Chain> chains = TraceStreets(&raster, &cells_of_junctions);
  const Junctions junctions(raster, cells_of_junctions, chains);
  std::vector<Road> roads;
  for (const Chain& chain : chains) {
    Polyline stairs;
    std::vector<float> widths;
    for (const int cell : chain.cells) {
      stairs.push_back(junctions.Place(cell));
      widths.push_back(to_edge[static_cast<std::size_t>(cell)]);
    }
    const std::int64_t from = junctions.Node(chain.cells.front());
    const std::int64_t to = junctions.Node(chain.cells.back());
    if (from == to && IsShort(chain)) continue;  // within one junction
    std::nth_element(widths.begin(), widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2), widths.end());
    const auto half_width_m = static_cast<double>(widths[widths.size() / 2]);
    Road road;
    road.id = static_cast<std::int64_t>(roads.size()) + 1;
    road.line = Resample(Smooth(stairs), kNode_m);
    road.half_width_m = std::clamp(half_width_m, kNarrowest_m, kWidest_m);
    road.nodes.push_back(from);
    for (std::size_t i = 1; i + 1 < road.line.size(); ++i) {
      road.nodes.push_back(road.id * 1'000'000 + 2'000'000'000 + static_cast<std::int64_t>(i));
    }
    road.nodes.push_back(to);
    roads.push_back(std::move(road));
  }
  return roads;
}

}  // namespace mapweld::sim
