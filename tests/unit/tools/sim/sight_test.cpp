// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/sight.hpp"

#include <gtest/gtest.h>

namespace mapweld::sim {
namespace {

const Polyline kStreet{{0, 0}, {1000, 0}, {1000, 500}};

TEST(Sight, ReachesAsFarAsAskedFromTheLineAndNotMuchFarther) {
  const Sight sight({&kStreet}, 160);
  for (double x = 0; x <= 1000; x += 7) {
    EXPECT_TRUE(sight.Contains({x, 130})) << x;
    EXPECT_TRUE(sight.Contains({x, -130})) << x;
    EXPECT_FALSE(sight.Contains({x, -200})) << x;
  }
  EXPECT_TRUE(sight.Contains({1120, 500}));
  EXPECT_FALSE(sight.Contains({500, 300})) << "inside the bounding box, but far from the line";
  EXPECT_FALSE(sight.Contains({1e6, 0}));
}

TEST(Sight, ListsExactlyTheSquaresItContains) {
  const Sight sight({&kStreet}, 100);
  const auto cells = sight.Cells();
  for (const Vec2d& corner : cells) EXPECT_TRUE(sight.Contains(corner + Vec2d::Constant(Sight::kCell_m / 2)));
  const double area = static_cast<double>(cells.size()) * Sight::kCell_m * Sight::kCell_m;
  EXPECT_NEAR(area, 1500 * 200 + 3.14 * 100 * 100, 0.15 * area);
}

}  // namespace
}  // namespace mapweld::sim
