// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/true_scans.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/support/temporary_directory.hpp"
#include "tools/io/recording_folder.hpp"
#include "tools/odometry/scan_export.hpp"

namespace mapweld::odometry {
namespace {

// A vehicle at 10 m/s along x looks at a post at (20, 5, 0) in the world, in every packet of a revolution.
std::vector<TrueScan> LookAtAPost() {
  std::vector<io::StampedPose> truth;
  for (int i = 0; i <= 40; ++i) {
    truth.push_back({{i * 10'000'000LL}, {{0.1 * i, 0, 0}, geom::Quatd::Identity()}});
  }
  std::vector<TrueScan> scans;
  TrueScans sink(truth, {}, [&scans](const TrueScan& scan) { scans.push_back(scan); });
  sensor::LidarPacket packet;
  for (int i = 0; i < 30; ++i) {
    const double t_s = 0.01 * i;
    packet.t = {i * 10'000'000LL};
    packet.azimuth_first_cdeg = static_cast<std::uint16_t>(i % 10 * 3600);
    packet.azimuth_last_cdeg = static_cast<std::uint16_t>(packet.azimuth_first_cdeg + 3500);
    packet.points.clear();
    EXPECT_EQ(packet.points.TryPush({static_cast<float>(20 - 10 * t_s), 5, 0, 0, 0, 0, 0}), Status::kOk);
    sink.OnPacket(packet);
  }
  sink.Flush();
  return scans;
}

TEST(TrueScans, OnePostStaysOnePostAlthoughTheVehicleDrivesPast) {
  const std::vector<TrueScan> scans = LookAtAPost();
  ASSERT_EQ(scans.size(), 3U);
  for (const TrueScan& scan : scans) {
    EXPECT_EQ(scan.points.size(), 10U);
    for (const Eigen::Vector3f& p : scan.points) {
      const geom::Vec3d p_world = scan.world_T_lidar * p.cast<double>();
      EXPECT_LT((p_world - geom::Vec3d(20, 5, 0)).norm(), 1e-3);
    }
  }
}

TEST(ScanExport, TheFolderIsARecordingLikeAnyOther) {
  const test::TemporaryDirectory folder;
  ScanExport out(folder.path() / "scans");
  const std::vector<TrueScan> scans = LookAtAPost();
  for (const TrueScan& scan : scans) out.Write(scan);
  EXPECT_EQ(out.Finish(), 3U);
  const io::RecordingFolder recording = io::RecordingFolder::Open(folder.path() / "scans");
  ASSERT_EQ(recording.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(recording.LoadScan(i).points, scans[i].points);
    EXPECT_LT((recording.world_T_lidar()[i].t - scans[i].world_T_lidar.t).norm(), 1e-5);
    EXPECT_NEAR(static_cast<double>((recording.times()[i] - scans[i].t).ns), 0, 10);
  }
}

}  // namespace
}  // namespace mapweld::odometry
