// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/parked_cars.hpp"

#include <gtest/gtest.h>

#include "tools/sim/procedural_town.hpp"

namespace mapweld::sim {
namespace {

class ParkedCars : public testing::Test {
 protected:
  TownMesh Park(std::uint64_t seed) const {
    TownMesh mesh;
    AddParkedCars(PlotsAlongStreets(town_, sight_), clearance_, seed, mesh);
    return mesh;
  }
  const Town town_ = InventTown({"suburb", 900, 5});
  const Polyline everywhere_{{-400, 0}, {400, 0}};
  const Sight sight_{{&everywhere_}, 400};
  const Clearance clearance_{town_, sight_};
};

TEST_F(ParkedCars, StandElsewhereInEveryDriveAndTheSameWhenItIsRepeated) {
  const Mesh monday = Of(Park(1), Surface::kCar);
  const Mesh tuesday = Of(Park(2), Surface::kCar);
  EXPECT_GT(monday.triangles.size(), 20U * 50);
  EXPECT_NE(monday.vertices, tuesday.vertices);
  EXPECT_EQ(monday.vertices, Of(Park(1), Surface::kCar).vertices);
}

TEST_F(ParkedCars, LeaveTheCarriagewaysFree) {
  const TownMesh parked = Park(3);
  for (const Eigen::Vector3f& vertex : Of(parked, Surface::kCar).vertices) {
    const Vec2d p = vertex.head<2>().cast<double>();
    for (const Road& road : town_.roads) {
      for (std::size_t i = 1; i < road.line.size(); ++i) {
        ASSERT_GT(DistanceToSegment(p, road.line[i - 1], road.line[i]), road.half_width_m) << p.transpose();
      }
    }
  }
}

}  // namespace
}  // namespace mapweld::sim
