// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/traffic.hpp"

#include <cmath>

#include "tools/sim/hash_noise.hpp"
#include "tools/sim/parked_cars.hpp"

namespace mapweld::sim {
namespace {

constexpr double kOncoming_m = 3.3;  // to the left of the lane
constexpr double kAhead_s = 2.4;     // gap to the car in front
constexpr double kBehind_s = 2.8;
constexpr double kCompanionFor_s = 25;  // a car in front or behind stays that long, or is not there that long
constexpr double kLeastGap_m = 8;

// A person, or one on a bicycle.
void AddPerson(const Vec2d& at, const Vec2d& along, bool cyclist, TownMesh* mesh) {
  Mesh& person = Of(*mesh, Surface::kPerson);
  const double low = cyclist ? 0.6 : 0.0;
  const double high = cyclist ? 1.75 : 1.7;
  const Polyline body = Rectangle(at, along, 0.16, 0.24);
  person.AddWalls(body, low, high);
  person.AddFace(body, high);
  if (cyclist) person.AddWalls(Rectangle(at, along, 0.85, 0.04), 0.05, 0.95);
}

}  // namespace

Traffic::Traffic(const LanePath& lane, const VehicleMotion& motion, const Relief& relief, double density,
                 std::uint64_t seed)
    : lane_(lane), motion_(motion), relief_(relief), density_(density), seed_(Hash(seed, 0x72AF)) {
  if (density <= 0) return;
  // Whoever the vehicle meets while it drives, spread evenly over what it drives.
  const auto spread = [&](Kind kind, double every_m, std::uint64_t stream) {
    const auto n = static_cast<std::uint64_t>(2 * lane.length_m() / every_m * density);
    for (std::uint64_t i = 0; i < n; ++i) {
      const std::uint64_t bits = Hash(seed_, stream, i);
      Mover mover{};
      mover.kind = kind;
      mover.seed = bits;
      if (kind == Kind::kPedestrian) {
        mover.s_at_start_m = Uniform(Hash(bits, 1), 0, lane.length_m());
        mover.speed_mps = Uniform(Hash(bits, 2), 0.8, 1.6) * (Uniform(Hash(bits, 3)) < 0.5 ? 1 : -1);
        mover.left_m = Uniform(Hash(bits, 4)) < 0.5 ? Uniform(Hash(bits, 5), -3.4, -2.7) : Uniform(Hash(bits, 5), 6, 7);
      } else {
        const bool cyclist = kind == Kind::kCyclist;
        mover.s_at_start_m = Uniform(Hash(bits, 1), 0, 2 * lane.length_m());
        mover.speed_mps = -(cyclist ? Uniform(Hash(bits, 2), 4, 7) : Uniform(Hash(bits, 2), 7, 12));
        mover.left_m = cyclist ? kOncoming_m + 0.9 : kOncoming_m;
      }
      movers_.push_back(mover);
    }
  };
  spread(Kind::kCar, 150, 1);
  spread(Kind::kCyclist, 500, 2);
  spread(Kind::kPedestrian, 120, 3);
}

void Traffic::Add(const Mover& mover, double t, TownMesh* mesh) const {
  const double s = mover.s_at_start_m + mover.speed_mps * t;
  const double heading = lane_.Heading(s);
  const Vec2d along(std::cos(heading), std::sin(heading));
  const Vec2d at = lane_.Position(s) + mover.left_m * Vec2d(-along.y(), along.x());
  const Vec2d looks = mover.speed_mps < 0 ? Vec2d(-along) : along;
  if (mover.kind == Kind::kCar) {
    AddCar(at, looks, mover.seed, *mesh);
  } else {
    AddPerson(at, looks, mover.kind == Kind::kCyclist, mesh);
  }
}

bool Traffic::HasCompanion(bool ahead, double t) const {
  const auto turn = static_cast<std::uint64_t>(t / kCompanionFor_s);
  return Uniform(Hash(seed_, ahead ? 4 : 5, turn)) < 0.4 * density_;
}

void Traffic::AddCompanions(double t, TownMesh* mesh) const {
  const geom::Vec3d here = motion_.WorldFromBody(t).t;
  for (const bool ahead : {true, false}) {
    const geom::Pose3 there = motion_.WorldFromBody(ahead ? t + kAhead_s : t - kBehind_s);
    // Where the vehicle stands the others would stand in it: they have turned off before.
    if (!HasCompanion(ahead, t) || (there.t - here).norm() < kLeastGap_m) continue;
    const double heading = geom::Yaw(there.q);
    const auto turn = static_cast<std::uint64_t>(t / kCompanionFor_s);
    AddCar(there.t.head<2>(), {std::cos(heading), std::sin(heading)}, Hash(seed_, ahead ? 6 : 7, turn), *mesh);
  }
}

Traffic::Moving Traffic::Between(double t_begin, double t_end) const {
  Moving moving;
  const Vec2d here = motion_.WorldFromBody(t_begin).t.head<2>();
  for (const Mover& mover : movers_) {
    const double s = mover.s_at_start_m + mover.speed_mps * t_begin;
    if (s < 0 || s > lane_.length_m() || (lane_.Position(s) - here).norm() > kSight_m) continue;
    Add(mover, t_begin, &moving.begin);
    Add(mover, t_end, &moving.end);
  }
  if (density_ > 0) {
    // Both moments or neither, so that the triangles stay the same.
    TownMesh begin;
    TownMesh end;
    AddCompanions(t_begin, &begin);
    AddCompanions(t_end, &end);
    Mesh& cars = Of(begin, Surface::kCar);
    Mesh& cars_later = Of(end, Surface::kCar);
    if (cars.vertices.size() == cars_later.vertices.size()) {
      Of(moving.begin, Surface::kCar).Append(cars);
      Of(moving.end, Surface::kCar).Append(cars_later);
    }
  }
  relief_.LiftOntoStreet(&moving.begin);
  relief_.LiftOntoStreet(&moving.end);
  return moving;
}

}  // namespace mapweld::sim
