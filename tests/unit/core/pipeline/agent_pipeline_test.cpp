// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/agent_pipeline.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

#include "core/base/crc32.hpp"
#include "core/submap/submap_codec.hpp"
#include "tests/support/street_drive.hpp"

namespace mapweld::pipeline {
namespace {

struct Record final : AgentSink {
  void OnPose(const PoseOutput& pose) override {
    poses.push_back(pose);
    const double t[3] = {pose.odometry.odom_T_body.t.x(), pose.odometry.odom_T_body.t.y(),
                         pose.odometry.odom_T_body.t.z()};
    crc = Crc32({reinterpret_cast<const std::uint8_t*>(t), sizeof(t)}, crc);
  }
  void OnKeyframe(const KeyframeOutput& keyframe) override {
    keyframes.push_back(keyframe);
    crc = Crc32(keyframe.encoded, crc);
    const auto& q = keyframe.place.descriptor.q;
    crc = Crc32({reinterpret_cast<const std::uint8_t*>(q.data()), q.size()}, crc);
    decoded = std::make_unique<submap::Submap>();
    EXPECT_EQ(submap::DecodeSubmap(keyframe.encoded, decoded.get()), Status::kOk);
  }
  std::vector<PoseOutput> poses;
  std::vector<KeyframeOutput> keyframes;
  std::unique_ptr<submap::Submap> decoded;
  std::uint32_t crc = 0;
};

class AgentPipelineTest : public testing::Test {
 protected:
  void Drive(const test::StreetDriveConfig& config, Record* record) {
    street_ = std::make_unique<test::StreetDrive>(config);
    agent_ = std::make_unique<AgentPipeline>(AgentConfig{}, record);
    while (street_->Step(agent_.get())) {
    }
  }
  std::unique_ptr<test::StreetDrive> street_;
  std::unique_ptr<AgentPipeline> agent_;
};

TEST_F(AgentPipelineTest, TakesAKeyframeEveryFiveMetresAndHoldsItBackForAHundred) {
  Record record;
  Drive({.seconds = 22}, &record);
  const double path = agent_->path_m();
  ASSERT_GT(path, 120);
  ASSERT_FALSE(record.keyframes.empty());
  EXPECT_NEAR(static_cast<double>(record.keyframes.size()), (path - 100) / 5, 2);
  agent_->OnDriveEnd();
  EXPECT_NEAR(static_cast<double>(record.keyframes.size()), path / 5 + 1, 2);
  for (std::size_t i = 0; i < record.keyframes.size(); ++i) {
    EXPECT_EQ(record.keyframes[i].index, static_cast<int>(i));
    EXPECT_NEAR(record.keyframes[i].path_m, 5.0 * static_cast<double>(i), 1.0);
    EXPECT_EQ(record.keyframes[i].flushed, record.keyframes[i].path_m > path - 100) << i;
    EXPECT_GT(record.keyframes[i].place.descriptor.scale, 0) << i;
  }
  EXPECT_GT(record.decoded->points.size(), 1000U);
}

TEST_F(AgentPipelineTest, TheSameInputGivesTheSameBytes) {
  Record first;
  Drive({.seconds = 10}, &first);
  agent_->OnDriveEnd();
  Record second;
  Drive({.seconds = 10}, &second);
  agent_->OnDriveEnd();
  ASSERT_GT(first.keyframes.size(), 5U);
  EXPECT_EQ(first.crc, second.crc);
}

// Every kind of bad input, at random, in between the good: all of it is refused and the drive comes out nearly the
// same.
class Faults : public AgentPipelineTest, public testing::WithParamInterface<unsigned> {
 protected:
  bool Chance(unsigned one_in) { return rng_() % one_in == 0; }

  void Imu(sensor::ImuSample sample) {
    agent_->OnImu(sample);
    if (Chance(20)) agent_->OnImu(sample);  // no time between the two
    sample.t = sample.t - Milliseconds(70);
    if (Chance(20)) agent_->OnImu(sample);
    sample.t = sample.t + Milliseconds(71);
    sample.gyro_body.x() = NAN;
    if (Chance(20)) agent_->OnImu(sample);
    sample.gyro_body.x() = 0;
    sample.accel_body.y() = INFINITY;
    if (Chance(20)) agent_->OnImu(sample);
  }
  void Packet(sensor::LidarPacket* packet) {
    for (sensor::LidarPoint& point : packet->points) {
      if (Chance(100)) point.x = NAN;
      if (Chance(100)) point.y = INFINITY;
      if (Chance(200)) point.z = 1e30F;
    }
    agent_->OnPacket(*packet);
    if (Chance(20)) agent_->OnPacket(*packet);
    packet->t = packet->t - Milliseconds(static_cast<std::int64_t>(1 + rng_() % 1000));
    if (Chance(20)) agent_->OnPacket(*packet);  // out of order
    packet->points.clear();
    if (Chance(20)) agent_->OnPacket(*packet);  // and empty
  }

  std::mt19937 rng_{GetParam()};
};

TEST_P(Faults, AStreamFullOfThemDoesNotBendTheDrive) {
  Record record;
  street_ = std::make_unique<test::StreetDrive>(test::StreetDriveConfig{.seconds = 15});
  agent_ = std::make_unique<AgentPipeline>(AgentConfig{}, &record);
  const auto packet = std::make_unique<sensor::LidarPacket>();
  FixedVector<sensor::ImuSample, 16> samples;
  while (street_->Next(packet.get(), &samples)) {
    for (const sensor::ImuSample& sample : samples) Imu(sample);
    Packet(packet.get());
  }
  agent_->OnDriveEnd();
  EXPECT_GT(agent_->counters().imu_refused, 400U);
  EXPECT_GT(agent_->counters().packets_stale, 100U);
  const auto& last = record.poses.back().odometry;
  EXPECT_LT((last.odom_T_body.t - street_->TruthAt(last.t).t).norm(), 0.01 * agent_->path_m());
  for (const PoseOutput& pose : record.poses) ASSERT_TRUE(pose.odometry.odom_T_body.IsValid());
}

// The clock of the IMU jumps ahead by an hour for some samples: what follows is believed again, the drive goes on.
TEST_P(Faults, AStampThatJumpsDoesNotEndTheDrive) {
  Record record;
  street_ = std::make_unique<test::StreetDrive>(test::StreetDriveConfig{.seconds = 15});
  agent_ = std::make_unique<AgentPipeline>(AgentConfig{}, &record);
  const auto packet = std::make_unique<sensor::LidarPacket>();
  FixedVector<sensor::ImuSample, 16> samples;
  int jumps = 0;
  while (street_->Next(packet.get(), &samples)) {
    for (sensor::ImuSample sample : samples) {
      if (sample.t.ns > 6'000'000'000 && jumps < 3 && Chance(100)) {
        ++jumps;
        sample.t = sample.t + Milliseconds(3'600'000);
      }
      agent_->OnImu(sample);
    }
    agent_->OnPacket(*packet);
  }
  agent_->OnDriveEnd();
  ASSERT_EQ(jumps, 3);
  const auto& last = record.poses.back().odometry;
  EXPECT_GT(static_cast<double>(last.t.ns) * 1e-9, 14);
  EXPECT_LT((last.odom_T_body.t - street_->TruthAt(last.t).t).norm(), 0.01 * agent_->path_m());
}

INSTANTIATE_TEST_SUITE_P(Seeds, Faults, testing::Values(5U, 6U, 7U));

TEST_F(AgentPipelineTest, WithoutImuNothingIsMadeUp) {
  Record record;
  Drive({.seconds = 3, .imu_gap_from_s = 0, .imu_gap_to_s = 100}, &record);
  agent_->OnDriveEnd();
  EXPECT_TRUE(record.poses.empty());
  EXPECT_TRUE(record.keyframes.empty());
  EXPECT_GT(agent_->counters().scans_dropped, 10U);
}

TEST_F(AgentPipelineTest, ScansGoOnWhenTheImuFallsSilent) {
  Record record;
  Drive({.seconds = 12, .imu_gap_from_s = 6, .imu_gap_to_s = 100}, &record);
  agent_->OnDriveEnd();
  EXPECT_GT(static_cast<double>(record.poses.back().odometry.t.ns) * 1e-9, 11);
}

TEST_F(AgentPipelineTest, PublishesTheMergedPoseOnceTheHostHasSentIt) {
  Record record;
  street_ = std::make_unique<test::StreetDrive>(test::StreetDriveConfig{.seconds = 10});
  agent_ = std::make_unique<AgentPipeline>(AgentConfig{}, &record);
  for (int i = 0; i < 75 * 60; ++i) street_->Step(agent_.get());
  EXPECT_EQ(record.poses.back().group, -1);
  EXPECT_EQ(record.poses.back().merged_T_body.t, record.poses.back().odometry.odom_T_body.t);
  correct::MergedPose merged;
  merged.group = 0;
  merged.merged_T_body = {{1000, 0, 0}, geom::Quatd::Identity()};  // of keyframe 0, which is the odometry's origin
  ASSERT_EQ(agent_->OnMergedPose(merged), Status::kOk);
  while (street_->Step(agent_.get())) {
  }
  EXPECT_EQ(record.poses.back().group, 0);
  EXPECT_NEAR(record.poses.back().merged_T_body.t.x() - record.poses.back().odometry.odom_T_body.t.x(), 1000, 1.0);
}

}  // namespace
}  // namespace mapweld::pipeline
