// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/path_town.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/tools/sim/test_folder.hpp"

namespace mapweld::sim {
namespace {

// A square of 200 m, driven twice, as KITTI writes poses: x to the right, z forward.
std::string TwiceAroundTheBlock() {
  std::string rows;
  for (int i = 0; i < 1600; ++i) {
    const int side = i / 200 % 4;
    const int along = i % 200;
    const int x = side == 0 ? 0 : side == 1 ? along : side == 2 ? 200 : 200 - along;
    const int z = side == 0 ? along : side == 1 ? 200 : side == 2 ? 200 - along : 0;
    rows += "1 0 0 " + std::to_string(x) + " 0 1 0 0 0 0 1 " + std::to_string(z) + "\n";
  }
  return rows;
}

TEST(PathTown, BuildsStreetsWherePathsRunAndHousesBesideThem) {
  const TestFolder folder;
  WriteText(folder / "a.txt", TwiceAroundTheBlock());
  WriteText(folder / "b.txt", TwiceAroundTheBlock());
  const PathTown built = BuildPathTown({folder / "", {"a", "b"}}, 1);
  ASSERT_EQ(built.drives.size(), 2U);
  EXPECT_NEAR(Length(built.drives[0].path.centreline), 1600, 40);
  EXPECT_NE(built.drives[0].zone, built.drives[1].zone);
  EXPECT_GT((built.drives[0].path.centreline.front() - built.drives[1].path.centreline.front()).norm(), 1000);
  EXPECT_GT(built.town.buildings.size(), 30U);
  for (const Building& building : built.town.buildings) {
    for (const SurveyedDrive& drive : built.drives) {
      for (const Vec2d& p : drive.path.centreline) {
        ASSERT_GT(DistanceToPolygon(building.footprint, p), 3.5) << "house " << building.id << " stands in the way";
      }
    }
  }
}

TEST(PathTown, ReadsTumTrajectoriesThatMeetInOneFrame) {
  const TestFolder folder;
  std::string east = "# timestamp x y z qx qy qz qw\n";
  std::string north = east;
  for (int i = 0; i < 300; ++i) {
    const std::string s = std::to_string(i);
    east += s + " " + s + " 100 5 0 0 0 1\n";
    north += s + " 150 " + s + " 5 0 0 0 1\n";
  }
  WriteText(folder / "east.txt", east);
  WriteText(folder / "north.txt", north);
  const PathTown built = BuildPathTown({folder / "", {"east", "north"}, true}, 1);
  EXPECT_EQ(built.drives[0].zone, built.drives[1].zone);
  EXPECT_EQ(built.drives[0].path.centreline.front(), Vec2d(0, 100));
  EXPECT_EQ(built.drives[1].path.centreline.front(), Vec2d(150, 0));
  for (const Building& building : built.town.buildings) {
    EXPECT_GT(DistanceToPolygon(building.footprint, {150, 100}), 3.5) << "where they cross";
  }
}

TEST(PathTown, SaysWhatIsMissingAndWhatIsWrong) {
  const TestFolder folder;
  EXPECT_THAT(MessageOf([&] {
                (void)BuildPathTown({folder / "", {"00"}}, 1);
              }),
              testing::HasSubstr("put the ground truth (KITTI: poses/*.txt, NCLT: as TUM) into that folder"));
  WriteText(folder / "00.txt", "1 0 0 0 0 1 0 0 0 0 1\n");
  EXPECT_THAT(MessageOf([&] { (void)BuildPathTown({folder / "", {"00"}}, 1); }), testing::HasSubstr("row 1"));
  WriteText(folder / "00.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_THAT(MessageOf([&] { (void)BuildPathTown({folder / "", {"00"}}, 1); }), testing::HasSubstr("no path"));
}

}  // namespace
}  // namespace mapweld::sim
