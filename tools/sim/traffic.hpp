// SPDX-License-Identifier: Apache-2.0
// What moves around a vehicle: cars that come towards it, one that it follows, one behind it, cyclists and pedestrians.
// Others in every drive; all a function of time.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/sim/lane_path.hpp"
#include "tools/sim/relief.hpp"
#include "tools/sim/town_mesh.hpp"
#include "tools/sim/vehicle_motion.hpp"

namespace mapweld::sim {

class Traffic {
 public:
  // `density`: 1 for a busy street, 0 for none. Refers to all its arguments.
  Traffic(const LanePath& lane, const VehicleMotion& motion, const Relief& relief, double density, std::uint64_t seed);

  // Everything that moves within kSight_m of the vehicle between the two moments: where it is at the first, and the
  // same triangles where they are at the second.
  struct Moving {
    TownMesh begin;
    TownMesh end;
  };
  [[nodiscard]] Moving Between(double t_begin, double t_end) const;

  static constexpr double kSight_m = 70;

 private:
  enum class Kind : std::uint8_t { kCar, kCyclist, kPedestrian };
  // Drives along the lane at a constant speed, `left_m` beside it.
  struct Mover {
    Kind kind;
    double s_at_start_m;
    double speed_mps;  // against the vehicle: negative
    double left_m;
    std::uint64_t seed;
  };
  void Add(const Mover& mover, double t, TownMesh* mesh) const;
  void AddCompanions(double t, TownMesh* mesh) const;
  [[nodiscard]] bool HasCompanion(bool ahead, double t) const;

  const LanePath& lane_;
  const VehicleMotion& motion_;
  const Relief& relief_;
  double density_;
  std::uint64_t seed_;
  std::vector<Mover> movers_;
};

}  // namespace mapweld::sim
