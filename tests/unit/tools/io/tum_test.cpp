// SPDX-License-Identifier: Apache-2.0
#include "tools/io/tum.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tools/io/temp_folder.hpp"
#include "tools/io/text_rows.hpp"

namespace mapweld::io {
namespace {

using ::testing::HasSubstr;

TEST(Tum, RoundTripsPosesAndExactTimes) {
  const test::TempFolder folder;
  const std::vector<StampedPose> trajectory = {{{1673400472138016708}, {{1, 2, 3}, geom::ExpSo3({0.3, -1, 0.5})}},
                                               {{1673400472138016709}, {{-4000.5, 2, 3}, geom::ExpSo3({0, 0, 3})}}};
  WriteTum(folder / "a.tum", trajectory);
  const auto back = ReadTum(folder / "a.tum");
  ASSERT_EQ(back.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back[i].t, trajectory[i].t);
    EXPECT_LT(geom::LocalCoordinates(trajectory[i].world_T_body, back[i].world_T_body).norm(), 1e-6);
  }
}

TEST(Tum, NamesTheLineThatIsWrong) {
  const test::TempFolder folder;
  const auto error = [&](const std::string& row) {
    return test::ErrorOf([&] { (void)ReadTum(folder.Put("a.tum", "# head\n1 0 0 0 0 0 0 1\n" + row)); });
  };
  EXPECT_EQ(error("2 0 0 0 0 0 0 1\n"), "");
  EXPECT_THAT(error("2 0 0 0 0 0 0\n"), HasSubstr("a.tum:3: found 7 numbers where 8 belong"));
  EXPECT_THAT(error("2 0 0 inf 0 0 0 1\n"), HasSubstr("a.tum:3: column 4 is inf"));
  EXPECT_THAT(error("2 0 0 0 0 0 0 0\n"), HasSubstr("a.tum:3: the quaternion has length 0.000"));
  EXPECT_THAT(error("1 0 0 0 0 0 0 1\n"), HasSubstr("a.tum:3: time does not increase"));
  EXPECT_THAT(error("soon 0 0 0 0 0 0 1\n"), HasSubstr("a.tum:3: 'soon' is not a time"));
}

TEST(Tum, ReadsPositionsWhereRotationsAreNone) {
  const test::TempFolder folder;
  const auto path = folder.Put("a.tum", "1 5 6 7 0 0 0 0\n2 8 9 10 0.1 0.2 -1.4 0\n3 1 1 1 0 0 1 0\n");
  EXPECT_THAT(test::ErrorOf([&] { (void)ReadTum(path); }), HasSubstr("a.tum:1: the quaternion"));
  const auto trajectory = ReadTum(path, PoseUse::kPositions);
  ASSERT_EQ(trajectory.size(), 3U);
  EXPECT_EQ(trajectory[1].world_T_body.t, geom::Vec3d(8, 9, 10));
  EXPECT_TRUE(trajectory[1].world_T_body.IsValid());
  EXPECT_EQ(trajectory[2].world_T_body.q.z(), 1);
}

}  // namespace
}  // namespace mapweld::io
