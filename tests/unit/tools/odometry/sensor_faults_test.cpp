// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/sensor_faults.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace mapweld::odometry {
namespace {

struct Collector final : SensorSink {
  void OnImu(const sensor::ImuSample& sample) override { imu.push_back(sample); }
  void OnPacket(const sensor::LidarPacket& packet) override {
    ++packets;
    if (!packet.points.empty()) last = packet.points[0];
  }
  std::vector<sensor::ImuSample> imu;
  int packets = 0;
  sensor::LidarPoint last;
};

// Ten seconds at 100 Hz of samples and packets with one point ahead.
Collector Play(const std::string& fault) {
  Collector collector;
  const auto faulty = MakeFaults({ParseFault(fault)}, &collector);
  sensor::LidarPacket packet;
  EXPECT_EQ(packet.points.TryPush({10, 0, 0, 0, 0, 0, 0}), Status::kOk);
  for (int i = 0; i < 1000; ++i) {
    const TimeNs t{i * 10'000'000LL};
    faulty->OnImu({t, {0.001 * i, 0, 0}, {0, 0, 9.81}, false});
    packet.t = t;
    faulty->OnPacket(packet);
  }
  return collector;
}

TEST(SensorFaults, LeaveOutWhatIsAskedFor) {
  EXPECT_EQ(Play("imu-gap:1:4").imu.size(), 900U);
  EXPECT_EQ(Play("imu-gap:1:4").packets, 1000);
  EXPECT_EQ(Play("lidar-gap:2:4").packets, 800);
  EXPECT_NEAR(Play("packet-loss:10").packets, 900, 40);
}

TEST(SensorFaults, AStuckImuRepeatsItsLastGoodValue) {
  const Collector stuck = Play("imu-stuck:1:4");
  EXPECT_DOUBLE_EQ(stuck.imu[450].gyro_body.x(), stuck.imu[399].gyro_body.x());
  EXPECT_DOUBLE_EQ(stuck.imu[600].gyro_body.x(), 0.6);
}

TEST(SensorFaults, ATiltedLidarSeesTheRoadAheadElsewhere) {
  EXPECT_NEAR(Play("tilted:5").last.z, -10 * 0.0872, 1e-3);
  EXPECT_NEAR(Play("shifted:10").last.x, 10.1, 1e-5);
}

TEST(SensorFaults, AWrongNameIsToldWithTheRightOnes) {
  EXPECT_THROW(ParseFault("imu-gone:1"), std::runtime_error);
  EXPECT_THROW(ParseFault("imu-gap"), std::runtime_error);
  EXPECT_THROW(ParseFault("imu-gap:soon"), std::runtime_error);
}

}  // namespace
}  // namespace mapweld::odometry
