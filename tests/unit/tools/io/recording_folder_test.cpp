// SPDX-License-Identifier: Apache-2.0
#include "tools/io/recording_folder.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/tools/io/temp_folder.hpp"
#include "tools/io/kitti.hpp"
#include "tools/io/pcd.hpp"
#include "tools/io/ply.hpp"
#include "tools/io/tum.hpp"

namespace mapweld::io {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

geom::Pose3 PoseAt(double x) {
  return {{x, 0, 0}, geom::Quatd::Identity()};
}
PointCloud CloudAt(float x) {
  return {{{x, 1, 1}}, {}, {}};
}

// Scan i has one point with x = i + 1, pose i is at x = 10 i, for i in `frames`.
void PutKitti(const test::TempFolder& folder, const std::vector<int>& frames, int poses) {
  std::filesystem::create_directories(folder / "velodyne");
  for (const int i : frames) {
    WriteKittiCloud(folder / fmt::format("velodyne/{:06}.bin", i), CloudAt(static_cast<float>(i + 1)));
  }
  std::vector<geom::Pose3> rows;
  for (int i = 0; i < poses; ++i) rows.push_back(PoseAt(10.0 * i));
  WriteKittiPoses(folder / "poses.txt", rows);
}

std::vector<double> PosesX(const RecordingFolder& recording) {
  std::vector<double> x;
  for (const geom::Pose3& pose : recording.world_T_lidar()) x.push_back(pose.t.x());
  return x;
}

std::vector<float> FirstX(const RecordingFolder& recording) {
  std::vector<float> x;
  for (std::size_t i = 0; i < recording.size(); ++i) x.push_back(recording.LoadScan(i).points.at(0).x());
  return x;
}

std::string OpenError(const std::filesystem::path& path) {
  return test::ErrorOf([&] { (void)RecordingFolder::Open(path); });
}

TEST(RecordingFolder, OpensTheKittiLayout) {
  const test::TempFolder folder;
  PutKitti(folder, {0, 1, 2}, 3);
  folder.Put("times.txt", "0.0\n0.1\n0.25\n");
  const auto recording = RecordingFolder::Open(folder.path());
  EXPECT_EQ(recording.name(), folder.path().filename().string());
  EXPECT_THAT(PosesX(recording), ElementsAre(0, 10, 20));
  EXPECT_THAT(FirstX(recording), ElementsAre(1, 2, 3));
  EXPECT_EQ(recording.times()[2].ns, 250'000'000);
  EXPECT_THAT(recording.notes(), IsEmpty());
}

TEST(RecordingFolder, AssumesTenScansPerSecondWithoutTimesAndSaysSo) {
  const test::TempFolder folder;
  PutKitti(folder, {0, 1}, 2);
  const auto recording = RecordingFolder::Open(folder.path());
  EXPECT_EQ(recording.times()[1].ns, 100'000'000);
  EXPECT_THAT(recording.notes(), ElementsAre(HasSubstr("10 scans per second assumed")));
}

TEST(RecordingFolder, TurnsCameraPosesIntoLidarPoses) {
  const test::TempFolder folder;
  PutKitti(folder, {0, 1}, 2);
  // The camera looks along x of the LiDAR and sits 0.3 m in front of it; it moves 10 m along its own z.
  folder.Put("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 10\n");
  folder.Put("calib.txt", "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 -0.3\n");
  const auto recording = RecordingFolder::Open(folder.path());
  EXPECT_LT(geom::LocalCoordinates(recording.world_T_lidar()[0], {}).norm(), 1e-9);
  EXPECT_LT(geom::LocalCoordinates(recording.world_T_lidar()[1], PoseAt(10)).norm(), 1e-9);
}

TEST(RecordingFolder, SortsCloudsByNumberNotByLetter) {
  const test::TempFolder folder;
  for (const int i : {1, 2, 10}) WritePcd(folder / fmt::format("cloud_{}.pcd", i), CloudAt(static_cast<float>(i)));
  WriteTum(folder / "trajectory.txt", {{{0}, PoseAt(0)}, {{100}, PoseAt(1)}, {{200}, PoseAt(2)}});
  const auto recording = RecordingFolder::Open(folder.path());
  EXPECT_THAT(FirstX(recording), ElementsAre(1, 2, 10));
  EXPECT_THAT(PosesX(recording), ElementsAre(0, 1, 2));
  EXPECT_EQ(recording.times()[2].ns, 200);
}

// One layout per unit in which programs write times into file names.
TEST(RecordingFolder, MatchesNamesThatAreTimesToTheNearestPose) {
  const char* const layouts[][3] = {{"1673400472.100", "1673400472.200", "1673400472.300"},
                                    {"1673400472100", "1673400472200", "1673400472300"},
                                    {"1673400472100000", "1673400472200000", "1673400472300000"},
                                    {"1673400472100000000", "1673400472200000000", "1673400472300000000"},
                                    {"1673400472_100000000", "1673400472_200000000", "1673400472_300000000"}};
  for (const auto& names : layouts) {
    const test::TempFolder folder;
    std::filesystem::create_directories(folder / "clouds");
    for (std::size_t i = 0; i < 3; ++i) {
      WritePly(folder / fmt::format("clouds/{}.ply", names[i]), CloudAt(static_cast<float>(i)));
    }
    // Twice as many poses as clouds, each a little off, and none near the first cloud.
    folder.Put("odometry.tum",
               "1673400472.190 1 0 0 0 0 0 1\n1673400472.215 2 0 0 0 0 0 1\n1673400472.260 3 0 0 0 0 0 1\n"
               "1673400472.310 4 0 0 0 0 0 1\n1673400472.400 5 0 0 0 0 0 1\n1673400472.500 6 0 0 0 0 0 1\n");
    const auto recording = RecordingFolder::Open(folder.path());
    EXPECT_THAT(FirstX(recording), ElementsAre(1, 2)) << names[0];
    EXPECT_THAT(PosesX(recording), ElementsAre(1, 4)) << names[0];
    EXPECT_EQ(recording.times()[0].ns, 1673400472200000000) << "the time of the scan, not of the pose";
    EXPECT_THAT(recording.notes(), ElementsAre(HasSubstr("1 of 3 clouds have no pose within 0.05 s")));
  }
}

TEST(RecordingFolder, RefusesClocksThatDoNotMeet) {
  const test::TempFolder folder;
  for (int i = 0; i < 3; ++i) WritePcd(folder / fmt::format("1673400472.{}50.pcd", i), CloudAt(1));
  WriteTum(folder / "a.tum", {{{1673400471000000000}, PoseAt(0)}, {{1673400473000000000}, PoseAt(0)}});
  EXPECT_THAT(OpenError(folder.path()), AllOf(HasSubstr("only 0 of 3 clouds"), HasSubstr("the same clock")));
}

TEST(RecordingFolder, TakesThePoseByFrameNumberWhenTheRecordingWasThinned) {
  const test::TempFolder folder;
  PutKitti(folder, {0, 5, 9}, 10);
  const auto recording = RecordingFolder::Open(folder.path());
  EXPECT_THAT(PosesX(recording), ElementsAre(0, 50, 90));
  EXPECT_EQ(recording.times()[1].ns, 500'000'000);
  EXPECT_THAT(recording.notes(), ::testing::Contains(HasSubstr("10 poses for 3 clouds")));
}

TEST(RecordingFolder, FindsThePosesOfTheBenchmarkLayout) {
  const test::TempFolder folder;
  std::filesystem::create_directories(folder / "sequences/05/velodyne");
  WriteKittiCloud(folder / "sequences/05/velodyne/000000.bin", CloudAt(1));
  std::filesystem::create_directories(folder / "poses");
  WriteKittiPoses(folder / "poses/05.txt", {PoseAt(3)});
  EXPECT_THAT(PosesX(RecordingFolder::Open(folder / "sequences/05/")), ElementsAre(3));
}

TEST(RecordingFolder, DropsAndCountsPointsThatAreNone) {
  const test::TempFolder folder;
  PutKitti(folder, {0}, 1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  WriteKittiCloud(folder / "velodyne/000000.bin",
                  {{{1, 2, 3}, {nan, 0, 0}, {0, inf, 0}, {0, 0, 0}, {0, 0, 1}}, {}, {}});
  const LoadedScan scan = RecordingFolder::Open(folder.path()).LoadScan(0);
  EXPECT_THAT(scan.points, ElementsAre(Eigen::Vector3f(1, 2, 3), Eigen::Vector3f(0, 0, 1)));
  EXPECT_EQ(scan.dropped, 3U);
}

TEST(RecordingFolder, SaysWhatIsMissing) {
  const test::TempFolder folder;
  EXPECT_THAT(OpenError(folder / "none"), HasSubstr("none does not exist; check the path"));
  EXPECT_THAT(OpenError(folder.path()), HasSubstr("is empty; put clouds"));
  EXPECT_THAT(OpenError(folder.Put("file.txt", "x")), HasSubstr("is a file; give the folder"));
  EXPECT_THAT(OpenError(folder.path()), HasSubstr("no clouds in"));
  WriteKittiCloud(folder / "000000.bin", CloudAt(1));
  EXPECT_THAT(OpenError(folder.path()), HasSubstr("no poses in"));
  folder.Put("poses.txt", "# nothing\n");
  EXPECT_THAT(OpenError(folder.path()), HasSubstr("poses.txt has no poses"));
  folder.Put("poses.txt", "1 2 3\n");
  EXPECT_THAT(OpenError(folder.path()), HasSubstr("poses.txt:1: 3 values are no pose"));
}

TEST(RecordingFolder, NamesBothCountsWhenPosesAndCloudsDiffer) {
  const test::TempFolder fewer;
  PutKitti(fewer, {0, 1, 2}, 2);
  EXPECT_THAT(OpenError(fewer.path()), AllOf(HasSubstr("poses.txt has 2 poses for 3 clouds in"),
                                             HasSubstr("velodyne; give one pose per cloud")));
  const test::TempFolder more;
  PutKitti(more, {0, 1, 2}, 7);
  EXPECT_THAT(OpenError(more.path()), HasSubstr("poses.txt has 7 poses for 3 clouds"));
  const test::TempFolder times;
  PutKitti(times, {0, 1, 2}, 3);
  times.Put("times.txt", "0\n1\n");
  EXPECT_THAT(OpenError(times.path()), HasSubstr("times.txt has 2 times for 3 poses"));
}

TEST(RecordingFolder, FindsATruncatedCloudWhenOpened) {
  const test::TempFolder folder;
  PutKitti(folder, {0, 1, 2}, 3);
  folder.Put("velodyne/000001.bin", std::string(24, 'x'));
  EXPECT_THAT(OpenError(folder.path()), HasSubstr("000001.bin is truncated: 24 bytes"));
}

TEST(RecordingFolder, AsksWhichOfSeveralTrajectoriesToUse) {
  const test::TempFolder folder;
  WriteKittiCloud(folder / "000000.bin", CloudAt(1));
  WriteTum(folder / "a.tum", {{{0}, PoseAt(1)}});
  WriteTum(folder / "b.tum", {{{0}, PoseAt(2)}});
  EXPECT_THAT(OpenError(folder.path()), HasSubstr("several trajectories (a.tum, b.tum)"));
  WriteTum(folder / "poses.txt", {{{0}, PoseAt(3)}});
  EXPECT_THAT(PosesX(RecordingFolder::Open(folder.path())), ElementsAre(3));
}

}  // namespace
}  // namespace mapweld::io
