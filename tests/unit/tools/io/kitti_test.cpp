// SPDX-License-Identifier: Apache-2.0
#include "tools/io/kitti.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tools/io/temp_folder.hpp"
#include "tools/io/text_rows.hpp"

namespace mapweld::io {
namespace {

using ::testing::HasSubstr;

TEST(KittiCloud, RoundTripsEveryBit) {
  const test::TempFolder folder;
  const PointCloud cloud{{{1, 2, 3}, {-4.5F, 1e-7F, 80}}, {}, {0.25F, 1}};
  WriteKittiCloud(folder / "0.bin", cloud);
  EXPECT_EQ(std::filesystem::file_size(folder / "0.bin"), 32U);
  const PointCloud back = ReadKittiCloud(folder / "0.bin");
  EXPECT_EQ(back.points, cloud.points);
  EXPECT_EQ(back.intensities, cloud.intensities);
}

TEST(KittiCloud, NamesFileAndOffsetOfEveryTruncation) {
  const test::TempFolder folder;
  for (std::size_t size = 0; size < 48; ++size) {
    const auto path = folder.Put("7.bin", std::string(size, '\0'));
    const std::string error = test::ErrorOf([&] { (void)ReadKittiCloud(path); });
    if (size % 16 == 0) {
      EXPECT_EQ(error, "") << size;
    } else {
      EXPECT_THAT(error, HasSubstr("7.bin is truncated: " + std::to_string(size) + " bytes"));
      EXPECT_THAT(error, HasSubstr("offset " + std::to_string(size / 16 * 16)));
    }
  }
}

TEST(KittiPoses, RoundTripToTheLastWrittenDigit) {
  const test::TempFolder folder;
  const std::vector<geom::Pose3> poses = {{{1, -2000.123456789, 3}, geom::ExpSo3({0.1, -0.2, 2.9})}, {}};
  WriteKittiPoses(folder / "poses.txt", poses);
  const auto back = ReadKittiPoses(folder / "poses.txt");
  ASSERT_EQ(back.size(), 2U);
  EXPECT_LT(geom::LocalCoordinates(poses[0], back[0]).norm(), 1e-8);
  EXPECT_LT(geom::LocalCoordinates(poses[1], back[1]).norm(), 1e-8);
}

TEST(KittiPoses, NameTheLineThatIsWrong) {
  const test::TempFolder folder;
  const std::string good = "1 0 0 5 0 1 0 6 0 0 1 7\n";
  const auto error = [&](const std::string& row) {
    return test::ErrorOf([&] { (void)ReadKittiPoses(folder.Put("poses.txt", good + row)); });
  };
  EXPECT_EQ(error(good), "");
  EXPECT_THAT(error("1 0 0 5 0 1 0 6 0 0 1\n"), HasSubstr("poses.txt:2: found 11 numbers where 12 belong"));
  EXPECT_THAT(error("1 0 0 nan 0 1 0 6 0 0 1 7\n"), HasSubstr("poses.txt:2: column 4 is nan"));
  EXPECT_THAT(error("1 0 0 5 0 1 0 6 0 0 one 7\n"), HasSubstr("poses.txt:2: 'one' is not a number"));
  EXPECT_THAT(error("2 0 0 5 0 2 0 6 0 0 2 7\n"), HasSubstr("poses.txt:2: the 3x3 part is not a rotation"));
  EXPECT_THAT(error("1 0 0 5 0 1 0 6 0 0 -1 7\n"), HasSubstr("not a rotation")) << "a mirror image";
  EXPECT_THAT(error("0 0 0 0 0 0 0 0 0 0 0 0\n"), HasSubstr("not a rotation")) << "the row of a lost frame";
}

TEST(KittiPoses, ForgiveRoundingAndNormaliseIt) {
  const test::TempFolder folder;
  const auto poses = ReadKittiPoses(folder.Put("poses.txt", "0.866 -0.5 0 1 0.5 0.866 0 2 0 0 1 3\n"));
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_NEAR(poses[0].q.norm(), 1, 1e-12);
  EXPECT_NEAR(geom::Yaw(poses[0].q), M_PI / 6, 1e-4);
}

TEST(KittiTimes, MustIncrease) {
  const test::TempFolder folder;
  const auto times = ReadKittiTimes(folder.Put("times.txt", "0.000000e+00\n1.036224e-01\n"));
  ASSERT_EQ(times.size(), 2U);
  EXPECT_EQ(times[1].ns, 103622400);
  EXPECT_THAT(test::ErrorOf([&] { (void)ReadKittiTimes(folder.Put("times.txt", "0\n1\n1\n")); }),
              HasSubstr("times.txt:3: time does not increase"));
}

TEST(KittiCalibration, IsTheTrLineOrNothing) {
  const test::TempFolder folder;
  const auto tr = ReadKittiCalibration(
      folder.Put("calib.txt", "P0: 7 0 6 0 0 7 1 0 0 0 1 0\nTr: 0 -1 0 0.1 0 0 -1 0.2 1 0 0 0.3\n"));
  ASSERT_TRUE(tr.has_value());
  EXPECT_LT((*tr * geom::Vec3d(10, 0, 0) - geom::Vec3d(0.1, 0.2, 10.3)).norm(), 1e-12);
  EXPECT_FALSE(ReadKittiCalibration(folder.Put("calib.txt", "P0: 7 0 6 0 0 7 1 0 0 0 1 0\n")).has_value());
}

}  // namespace
}  // namespace mapweld::io
