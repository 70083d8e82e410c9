// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/procedural_town.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "tools/sim/hash_noise.hpp"
#include "tools/sim/house_clearance.hpp"

namespace mapweld::sim {
namespace {

constexpr double kFootway_m = 0.4;  // kept free behind the kerb whatever stands there

double Draw(std::uint64_t bits, const Range& range) {
  return Uniform(bits, range.low, range.high);
}

// Corners of a grid, bent out of shape, and the pieces of street between them.
class StreetGrid {
 public:
  StreetGrid(const TownPlan& plan, const TownStyle& style)
      : seed_(Hash(plan.seed, 0x612D)),
        style_(style),
        columns_(std::max(3, static_cast<int>(plan.size_m / style.block_x_m) + 1)),
        rows_(std::max(3, static_cast<int>(plan.size_m / style.block_y_m) + 1)),
        turn_(Uniform(Hash(seed_, 1), 0, 2 * std::numbers::pi)),
        cellar_m_(plan.cellar_m) {}

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }

  struct Street {
    Polyline line;  // from the corner with the lower index
    double half_width_m = 0;
    bool highway = false;
    bool covered = false;
    bool ramp = false;
    std::uint64_t seed = 0;
  };
  [[nodiscard]] bool Exists(int column, int row, bool across) const {
    const bool outermost = across ? column == 0 || column == columns_ - 1 : row == 0 || row == rows_ - 1;
    return outermost || IsMain(column, row, across) || Uniform(Hash(SeedOf(column, row, across), 2)) >= style_.removed;
  }
  // From corner (column, row) to the next one along x, or along y when `across`.
  [[nodiscard]] Street Get(int column, int row, bool across) const {
    const Vec2d from = Corner(column, row);
    const Vec2d to = across ? Corner(column, row + 1) : Corner(column + 1, row);
    Street street;
    street.seed = SeedOf(column, row, across);
    const bool main = IsMain(column, row, across);
    street.highway = main && style_.highways && !across;
    street.half_width_m = main ? style_.main_half_width_m : style_.half_width_m;
    street.covered = row + 1 < rows_ / 2 && Uniform(Hash(street.seed, 5)) < style_.covered_share;
    if (cellar_m_ > 0) {
      street.covered = row < CellarRow() || (row == CellarRow() && !across);
      street.ramp = row == CellarRow() && across;
    }
    const double bend = street.highway ? 0 : style_.bend_m * Gaussian(Hash(street.seed, 3));
    const Vec2d along = (to - from).normalized();
    constexpr int kPieces = 6;
    for (int i = 0; i <= kPieces; ++i) {
      const double u = static_cast<double>(i) / kPieces;
      street.line.emplace_back(from + u * (to - from) + 4 * u * (1 - u) * bend * Vec2d(-along.y(), along.x()));
    }
    return street;
  }
  // The level part holds all rows up to CellarRow(), with room for walls; ramps go on to just before the next row.
  [[nodiscard]] std::optional<Cellar> MakeCellar() const {
    if (cellar_m_ <= 0) return {};
    const double room_m = style_.main_half_width_m + kFootway_m + 1;
    const double x_m = 0.5 * (columns_ - 1) * style_.block_x_m + room_m;
    const double low_m = -0.5 * (rows_ - 1) * style_.block_y_m - room_m;
    const double edge_m = (CellarRow() - 0.5 * (rows_ - 1)) * style_.block_y_m + room_m;
    Cellar cellar;
    cellar.outline = {Turned({-x_m, low_m}), Turned({x_m, low_m}), Turned({x_m, edge_m}), Turned({-x_m, edge_m})};
    cellar.out = Turned(Vec2d::UnitY());
    cellar.edge_m = edge_m;
    cellar.ramp_m = style_.block_y_m - 2 * room_m;
    cellar.depth_m = cellar_m_;
    return cellar;
  }
  [[nodiscard]] std::int64_t NodeId(int column, int row) const { return 1'000'000 + column * 1000 + row; }
  // Distinct for every piece of street.
  [[nodiscard]] std::int64_t StreetId(int column, int row, bool across) const {
    return 2'000'000 + (column * 1000 + row) * 2 + (across ? 1 : 0);
  }

 private:
  [[nodiscard]] int CellarRow() const { return rows_ / 2 - 1; }
  [[nodiscard]] Vec2d Turned(const Vec2d& p) const {
    return {std::cos(turn_) * p.x() - std::sin(turn_) * p.y(), std::sin(turn_) * p.x() + std::cos(turn_) * p.y()};
  }
  [[nodiscard]] bool IsMain(int column, int row, bool across) const {
    return (across ? column : row) % style_.main_street_every == 0;
  }
  [[nodiscard]] std::uint64_t SeedOf(int column, int row, bool across) const {
    return Hash(seed_, static_cast<std::uint64_t>(StreetId(column, row, across)));
  }
  [[nodiscard]] Vec2d Corner(int column, int row) const {
    const std::uint64_t bits = Hash(seed_, static_cast<std::uint64_t>(NodeId(column, row)));
    const bool on_highway = style_.highways && row % style_.main_street_every == 0;
    const double jitter = on_highway ? 0 : style_.jitter;
    Vec2d p((column - 0.5 * (columns_ - 1) + jitter * Gaussian(Hash(bits, 1))) * style_.block_x_m,
            (row - 0.5 * (rows_ - 1) + jitter * Gaussian(Hash(bits, 2))) * style_.block_y_m);
    // Quarters drift as a whole: long waves.
    constexpr double kWave_m = 700;
    const double phase = Uniform(Hash(seed_, 4), 0, 2 * std::numbers::pi);
    const double k = 2 * std::numbers::pi / kWave_m;
    p += style_.swirl_m * Vec2d(std::sin(k * p.y() + phase), std::sin(k * p.x() + 2 * phase));
    return Turned(p);
  }

  std::uint64_t seed_;
  const TownStyle& style_;
  int columns_;
  int rows_;
  double turn_;
  double cellar_m_;
};

// A place along a street and the direction there.
struct Along {
  Vec2d at;
  Vec2d along;
  [[nodiscard]] Vec2d Left() const { return {-along.y(), along.x()}; }
};
Along Walk(const Polyline& line, double s) {
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vec2d step = line[i] - line[i - 1];
    if (s <= step.norm() || i + 1 == line.size()) {
      const Vec2d along = step.normalized();
      return {line[i - 1] + s * along, along};
    }
    s -= step.norm();
  }
  return {line.front(), Vec2d::UnitX()};
}

// Houses, fences and trees to the left of streets.
class RowBuilder {
 public:
  RowBuilder(const TownStyle& style, Town& town, std::int64_t first_id)
      : style_(style), town_(town), next_id_(first_id) {}
  [[nodiscard]] std::int64_t next_id() const { return next_id_; }

  // `line` has the row to its left; `corner_m`: kept free at the beginning, for the street that comes from there.
  void AddRow(const Polyline& line, double half_width_m, double corner_m, std::uint64_t seed) {
    const double end = Length(line) - corner_m - style_.setback_m.high - style_.depth_m.high - 1;
    double s = corner_m + style_.setback_m.low;
    for (std::uint64_t i = 0; s < end; ++i) {
      const std::uint64_t house = Hash(seed, i, 0x40E5);
      const double front = Draw(Hash(house, 1), style_.front_m);
      if (s + front > end + 3) break;
      const double setback = half_width_m + kFootway_m + Draw(Hash(house, 2), style_.setback_m);
      AddHouse(Walk(line, s + front / 2), front, setback, house);
      double gap = 0;
      if (Uniform(Hash(house, 3)) < style_.gap_share) gap = Draw(Hash(house, 4), style_.gap_m);
      AddGarden(line, s, s + front + gap, half_width_m, setback, house);
      s += front + gap;
    }
  }

  // A rail at the edge, and now and then a wall against the noise.
  void AddHighwaySide(const Polyline& line, double half_width_m, std::uint64_t seed) {
    const double length = Length(line);
    constexpr double kJunction_m = 18;
    if (length < 3 * kJunction_m) return;
    const auto run = [&](double offset, double height) {
      Polyline rail;
      for (double s = kJunction_m; s < length - kJunction_m; s += 6) {
        const Along place = Walk(line, s);
        rail.emplace_back(place.at + offset * place.Left());
      }
      town_.barriers.push_back({next_id_++, std::move(rail), height, false});
    };
    run(half_width_m + 0.7, 0.75);
    if (Uniform(Hash(seed, 5)) < 0.3) run(half_width_m + 3.0, Uniform(Hash(seed, 6), 2, 4.5));
    for (std::uint64_t i = 0; i < 14; ++i) {
      const Along place = Walk(line, Uniform(Hash(seed, 7, i), kJunction_m, length - kJunction_m));
      const double out = half_width_m + Uniform(Hash(seed, 8, i), 6, 30);
      if (Uniform(Hash(seed, 9, i)) < 0.4) town_.trees.push_back({next_id_++, place.at + out * place.Left()});
    }
  }

 private:
  void AddHouse(const Along& place, double front, double setback, std::uint64_t seed) {
    const double depth = Draw(Hash(seed, 5), style_.depth_m);
    const auto at = [&](double along, double outward) -> Vec2d {
      return place.at + along * place.along + (setback + outward) * place.Left();
    };
    const double half = front / 2;
    Polyline footprint;
    if (Uniform(Hash(seed, 6)) < style_.wing) {
      // A wing behind one half of the house.
      const double wing = Uniform(Hash(seed, 7), 0.3, 0.8) * depth;
      const double split = Uniform(Hash(seed, 8), -0.4, 0.4) * half;
      if (Uniform(Hash(seed, 9)) < 0.5) {
        footprint = {at(-half, 0),     at(half, 0),     at(half, depth + wing), at(split, depth + wing),
                     at(split, depth), at(-half, depth)};
      } else {
        footprint = {at(-half, 0),           at(half, 0), at(half, depth), at(split, depth), at(split, depth + wing),
                     at(-half, depth + wing)};
      }
    } else {
      footprint = {at(-half, 0), at(half, 0), at(half, depth), at(-half, depth)};
    }
    town_.buildings.push_back({next_id_++, std::move(footprint), Draw(Hash(seed, 10), style_.height_m),
                               style_.flat_roofs ? RoofShape::kFlat : RoofShape::kAny});
  }

  void AddGarden(const Polyline& line, double from, double to, double half_width_m, double setback,
                 std::uint64_t seed) {
    const double outward = half_width_m + kFootway_m + 1.2;
    if (setback < outward + 1) return;
    const double kind = Uniform(Hash(seed, 11));
    if (kind < style_.hedge + style_.fence) {
      Polyline edge;
      for (double s = from + 0.5; s < to - 1.5; s += 3) {
        const Along place = Walk(line, s);
        edge.emplace_back(place.at + outward * place.Left());
      }
      const bool hedge = kind < style_.hedge;
      const double height = hedge ? Uniform(Hash(seed, 12), 0.9, 2.0) : Uniform(Hash(seed, 12), 0.8, 1.6);
      if (edge.size() > 1) town_.barriers.push_back({next_id_++, std::move(edge), height, hedge});
    }
    if (Uniform(Hash(seed, 13)) < style_.tree) {
      const Along place = Walk(line, Uniform(Hash(seed, 14), from, to));
      const double out = Uniform(Hash(seed, 15), outward + 1, std::max(setback - 1.5, outward + 1.2));
      town_.trees.push_back({next_id_++, place.at + out * place.Left()});
    }
  }

  const TownStyle& style_;
  Town& town_;
  std::int64_t next_id_;
};

Polyline Backwards(const Polyline& line) {
  return {line.rbegin(), line.rend()};
}

}  // namespace

void AddRowOfHouses(const Polyline& line, double half_width_m, double corner_m, const TownStyle& style,
                    std::uint64_t seed, std::int64_t* next_id, Town* town) {
  RowBuilder rows(style, *town, *next_id);
  rows.AddRow(line, half_width_m, corner_m, seed);
  *next_id = rows.next_id();
}

Town InventTown(const TownPlan& plan) {
  const TownStyle& style = StyleByName(plan.style);
  const StreetGrid grid(plan, style);
  Town town;
  town.cellar = grid.MakeCellar();
  RowBuilder rows(style, town, 10'000'000);
  for (int column = 0; column < grid.columns(); ++column) {
    for (int row = 0; row < grid.rows(); ++row) {
      for (const bool across : {false, true}) {
        if ((across ? row + 1 == grid.rows() : column + 1 == grid.columns()) || !grid.Exists(column, row, across)) {
          continue;
        }
        const StreetGrid::Street street = grid.Get(column, row, across);
        const std::int64_t id = grid.StreetId(column, row, across);
        std::vector<std::int64_t> nodes{grid.NodeId(column, row)};
        for (std::size_t i = 1; i + 1 < street.line.size(); ++i) {
          nodes.push_back(id * 16 + static_cast<std::int64_t>(i) + 100'000'000);
        }
        nodes.push_back(across ? grid.NodeId(column, row + 1) : grid.NodeId(column + 1, row));
        town.roads.push_back({id, std::move(nodes), street.line, street.half_width_m, true,
                              !street.highway && !street.covered && !street.ramp});
        for (const Vec2d& p : street.line) town.bounds.Extend(p);
        const double corner_m = style.main_half_width_m + kFootway_m;
        if (street.covered) {
          const double height_m = town.cellar ? Cellar::kCeiling_m : 3.2;
          town.passages.push_back({id, street.line, street.half_width_m, height_m, corner_m});
        } else if (street.ramp) {
          continue;  // its walls belong to the cellar
        } else if (street.highway) {
          rows.AddHighwaySide(street.line, street.half_width_m, Hash(street.seed, 20));
          rows.AddHighwaySide(Backwards(street.line), street.half_width_m, Hash(street.seed, 21));
        } else {
          rows.AddRow(street.line, street.half_width_m, corner_m, Hash(street.seed, 20));
          rows.AddRow(Backwards(street.line), street.half_width_m, corner_m, Hash(street.seed, 21));
        }
      }
    }
  }
  MoveHousesOffStreets(town);
  RemoveWhatBlocksStreets(&town);
  return town;
}

}  // namespace mapweld::sim
