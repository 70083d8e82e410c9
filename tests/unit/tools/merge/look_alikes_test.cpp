// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/look_alikes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/tools/merge/synthetic_town.hpp"

namespace mapweld::merge {
namespace {

// Houses of one size at one distance on both sides of a street along +x from (0, y), and poles where chance has them.
void AddRowOfEqualHouses(float y, float length_m, unsigned seed, SyntheticTown* town) {
  std::mt19937 random(seed);
  for (float x = 5; x < length_m; x += 15) {
    for (const float side : {-1.0F, 1.0F}) {
      town->AddBox({x, y + side * 12}, {10, 9}, 7);
      const float pole_x = x + static_cast<float>(random() % 10);
      town->AddBox({pole_x, y + side * 4.5F}, {0.5F, 0.5F}, 3);
    }
  }
}

class LookAlikesTest : public ::testing::Test {
 protected:
  LookAlikesTest() : town_(5) {
    town_.AddStreet({-40, 0}, 330);
    AddRowOfEqualHouses(400, 300, 6, &town_);
  }
  RecordedDrive Build(const TownDrive& drive) { return BuildDrive(drive.recording, {}, nullptr); }
  // The level of the drive's keyframe, compared with itself alone.
  double Level(const RecordedDrive& recorded, std::size_t keyframe) {
    const std::vector<RecordedDrive> drives{recorded};
    RecordedSubmaps source(drives);
    PreparedCache submaps(&source);
    LookAlikes look_alikes(recorded.drive, 0, recorded.drive, 0, &submaps, {});
    const auto at = static_cast<int>(keyframe);
    const double level = look_alikes.Level(at, at);
    EXPECT_EQ(look_alikes.Level(at, at), level);
    return level;
  }

  SyntheticTown town_;
};

TEST_F(LookAlikesTest, AreManyAlongEqualHouses) {
  const RecordedDrive drive = Build(DriveAlong(town_, "row", 10, 290, 400, 1));
  EXPECT_GT(Level(drive, drive.drive.keyframes.size() / 3), 0.6);
}

TEST_F(LookAlikesTest, AreFewAlongAStreetWhereNoHouseIsLikeTheOther) {
  const RecordedDrive drive = Build(DriveAlong(town_, "street", -20, 260, 0, 2));
  const double level = Level(drive, drive.drive.keyframes.size() / 3);
  EXPECT_GT(level, 0);
  EXPECT_LT(level, 0.5);
}

// There and back: the way back passes the same place, and must not be taken for another one.
TEST_F(LookAlikesTest, AreNotTheSamePlaceSeenAgain) {
  TownDrive there = DriveAlong(town_, "there and back", -20, 200, 0, 3);
  const std::size_t scans = there.truth.size();
  Recording back = there.recording;
  for (std::size_t i = scans; i-- > 0;) {
    back.world_T_lidar.push_back(there.recording.world_T_lidar[i]);
    back.times.push_back({static_cast<std::int64_t>(back.times.size()) * 100'000'000});
  }
  back.load_scan = [load = there.recording.load_scan, scans](int i) {
    const auto at = static_cast<std::size_t>(i);
    return load(static_cast<int>(at < scans ? at : 2 * scans - 1 - at));
  };
  const RecordedDrive drive = BuildDrive(back, {}, nullptr);
  EXPECT_LT(Level(drive, drive.drive.keyframes.size() / 5), 0.5);
}

TEST_F(LookAlikesTest, AreNoneOfADriveThatHasOnePlace) {
  const RecordedDrive drive = Build(DriveAlong(town_, "short", 0, 40, 0, 4));
  EXPECT_EQ(Level(drive, 2), 0);
}

}  // namespace
}  // namespace mapweld::merge
