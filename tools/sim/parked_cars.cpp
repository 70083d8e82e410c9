// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/parked_cars.hpp"

#include "tools/sim/hash_noise.hpp"

namespace mapweld::sim {

void AddCar(const Vec2d& centre, const Vec2d& along, std::uint64_t seed, TownMesh& mesh) {
  Mesh& car = Of(mesh, Surface::kCar);
  const bool van = Uniform(Hash(seed, 3)) < 0.12;
  const double half_length = van ? Uniform(Hash(seed, 1), 2.4, 2.9) : Uniform(Hash(seed, 1), 1.8, 2.4);
  const double half_width = van ? 0.98 : 0.88;
  const double height = van ? Uniform(Hash(seed, 2), 1.9, 2.6) : Uniform(Hash(seed, 2), 1.4, 1.75);
  const double bonnet = van ? 1.1 : 0.85;
  const double cabin_share = van ? 0.8 : Uniform(Hash(seed, 4), 0.5, 0.72);
  const Polyline body = Rectangle(centre, along, half_length, half_width);
  car.AddWalls(body, 0.2, bonnet);
  car.AddFace(body, bonnet);
  // The cabin narrows towards the roof: slanted windows.
  const Vec2d back = centre - (1 - cabin_share) * 0.6 * half_length * along;
  const Polyline low = Rectangle(back, along, half_length * cabin_share, half_width - 0.02);
  const Polyline high = Rectangle(back, along, half_length * cabin_share - (van ? 0.25 : 0.45), half_width - 0.15);
  const auto lift = [](const Vec2d& p, double z) { return Eigen::Vector3d(p.x(), p.y(), z); };
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t k = (i + 1) % 4;
    car.AddQuad(lift(low[i], bonnet), lift(low[k], bonnet), lift(high[k], height), lift(high[i], height));
  }
  car.AddFace(high, height);
}

void AddParkedCars(const std::vector<Plot>& plots, const Clearance& clearance, std::uint64_t seed, TownMesh& mesh) {
  const double how_many = Uniform(Hash(seed, 0xCA25), 0.5, 1.3);
  for (const Plot& plot : plots) {
    const double street = Uniform(Hash(plot.street, 1));
    const double share = how_many * (0.05 + 0.65 * street * street);
    const std::uint64_t car = Hash(seed, plot.seed);
    if (Uniform(Hash(car, 0)) >= share) continue;
    const Vec2d centre = plot.At(Uniform(Hash(car, 1), -0.7, 0.7), Uniform(Hash(car, 2), 1.3, 1.5));
    const bool free = clearance.IsFree(centre - 1.6 * plot.along, 0.9) && clearance.IsFree(centre, 0.9) &&
                      clearance.IsFree(centre + 1.6 * plot.along, 0.9);
    const bool looks_along = Uniform(Hash(car, 3)) < 0.5;
    if (free) AddCar(centre, looks_along ? plot.along : Vec2d(-plot.along), car, mesh);
  }
}

}  // namespace mapweld::sim
