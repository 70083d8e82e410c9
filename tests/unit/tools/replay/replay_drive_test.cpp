// SPDX-License-Identifier: Apache-2.0
#include "tools/replay/replay_drive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "tests/unit/tools/sim/test_folder.hpp"

namespace mapweld::replay {
namespace {

using testing::HasSubstr;

// An agent in simulated time: socket buffers of finite size, a processing speed, health messages every 100 ms.
class FakeAgent final : public AgentLink {
 public:
  // What goes wrong.
  bool silent = false;
  bool deaf_to_lidar = false;
  double hangs_after_s = 1e9;
  double restarts_after_s = 1e9;
  int ignores_end_commands = 0;
  double packets_per_s = 2000;
  std::int64_t buffer_packets = 70;
  std::int64_t buffer_frames = 140;

  FakeAgent() { first_.lidar_packets = 500; }  // it has seen data before

  void SendLidar(std::span<const std::uint8_t> datagram) override {
    EXPECT_EQ(datagram.size(), 1206U);
    sent_at_s.push_back(now_s_);
    if (deaf_to_lidar) return;
    if (waiting_packets_ < buffer_packets) {
      ++waiting_packets_;
    } else {
      ++lost;
    }
    most_waiting = std::max(most_waiting, waiting_packets_);
  }
  void SendCan(const can::CanFrame& frame) override {
    ++frames_sent;
    if (frame.id == 0x123) return;  // filtered by the kernel
    waiting_frames_ < buffer_frames ? ++waiting_frames_ : ++lost;
  }
  void SendEndDrive() override {
    ++end_commands;
    if (end_commands > ignores_end_commands) ended_ = true;
  }
  void Wait(double max_s) override { Pass(max_s > 0 ? std::max(max_s, 0.1) : 1e-5); }
  void SleepUntil(double time_s) override {
    if (time_s > now_s_) Pass(time_s - now_s_);
  }
  [[nodiscard]] const std::optional<mapweldlcm::health_t>& health() const override { return health_; }
  [[nodiscard]] double Now_s() const override { return now_s_; }

  std::vector<double> sent_at_s;
  std::int64_t frames_sent = 0;
  std::int64_t lost = 0;
  std::int64_t most_waiting = 0;
  int end_commands = 0;

 private:
  void Pass(double seconds) {
    now_s_ += seconds;
    if (now_s_ < hangs_after_s) {
      credit_ += seconds * packets_per_s;
      const auto n = std::min(waiting_packets_, static_cast<std::int64_t>(credit_));
      credit_ = std::min(credit_ - static_cast<double>(n), 1.0);
      waiting_packets_ -= n;
      done_packets_ += n;
      done_frames_ += waiting_frames_;
      waiting_frames_ = 0;
    }
    if (silent || now_s_ < next_health_s_) return;
    next_health_s_ = now_s_ + 0.05;
    health_ = first_;
    health_->epoch = now_s_ > restarts_after_s ? 2 : 1;
    health_->lidar_packets += done_packets_ * 3 / 4;
    health_->lidar_rejected += done_packets_ - done_packets_ * 3 / 4;  // refused is also taken
    health_->can_frames += done_frames_;
    health_->kernel_drops = lost;
    health_->mode = ended_ ? 4 : 2;
  }
  mapweldlcm::health_t first_{};
  std::optional<mapweldlcm::health_t> health_;
  double now_s_ = 1000;
  double next_health_s_ = 0;
  double credit_ = 0;
  std::int64_t waiting_packets_ = 0;
  std::int64_t waiting_frames_ = 0;
  std::int64_t done_packets_ = 0;
  std::int64_t done_frames_ = 0;
  bool ended_ = false;
};

// LiDAR packets at their real pace with the frames of 200 IMU samples per second between them.
class FakeRecording final : public EventSource {
 public:
  explicit FakeRecording(int packets, bool with_can = true) : packets_(packets), with_can_(with_can) {}
  bool Next(Event* event) override {
    *event = {};
    if (with_can_ && frame_ * 1'000'000 < packet_ * 1'327'104) {
      event->stamp_ns = frame_ * 1'000'000;
      event->frame.id = frame_ % 7 == 0 ? 0x123 : 0x032;
      ++frame_;
      return true;
    }
    if (packet_ == packets_) return false;
    event->stamp_ns = packet_ * 1'327'104;
    event->lidar = bytes_;
    ++packet_;
    return true;
  }

 private:
  int packets_;
  bool with_can_;
  std::int64_t packet_ = 0;
  std::int64_t frame_ = 0;
  std::array<std::uint8_t, 1206> bytes_{};
};

ReplaySummary Play(FakeAgent& agent, int packets, bool realtime = false) {
  FakeRecording recording(packets);
  return ReplayDrive(recording, agent, realtime, ReplayLimits{}, [](double) {});
}

TEST(ReplayDrive, LosesNothingHoweverSlowTheAgentIs) {
  for (const double speed : {50.0, 900.0, 1e6}) {
    FakeAgent agent;
    agent.packets_per_s = speed;
    const ReplaySummary summary = Play(agent, 3000);
    EXPECT_EQ(agent.lost, 0);
    EXPECT_LE(agent.most_waiting, 64);
    EXPECT_EQ(summary.packets, 3000);
    EXPECT_EQ(summary.frames, agent.frames_sent);
    EXPECT_NEAR(summary.recorded_s, 3.98, 0.01);
    EXPECT_EQ(agent.end_commands, 1);
  }
}

TEST(ReplayDrive, WaitsForTheAgentAndGivesUpOnASilentOne) {
  FakeAgent agent;
  agent.silent = true;
  EXPECT_THAT(sim::MessageOf([&] { (void)Play(agent, 10); }), HasSubstr("no health message within 30 s"));
  EXPECT_TRUE(agent.sent_at_s.empty());
  EXPECT_NEAR(agent.Now_s(), 1030, 0.3);
}

TEST(ReplayDrive, SaysWhatIsMissingWhenTheAgentStopsTakingData) {
  FakeAgent deaf;
  deaf.deaf_to_lidar = true;
  EXPECT_THAT(sim::MessageOf([&] { (void)Play(deaf, 1000); }),
              testing::AllOf(HasSubstr("taken nothing for 10 s"), HasSubstr("64 LiDAR packets")));
  FakeAgent hung;
  hung.hangs_after_s = 1000.5;
  EXPECT_THAT(sim::MessageOf([&] { (void)Play(hung, 5000); }), HasSubstr("taken nothing for 10 s"));
}

TEST(ReplayDrive, NoticesDataThatTheKernelDropped) {
  FakeAgent agent;
  agent.buffer_packets = 20;
  agent.packets_per_s = 10;
  EXPECT_THAT(sim::MessageOf([&] { (void)Play(agent, 200); }), testing::ContainsRegex("kernel dropped [1-9]"));
}

TEST(ReplayDrive, NoticesARestart) {
  FakeAgent agent;
  agent.restarts_after_s = 1000.7;
  agent.packets_per_s = 700;
  EXPECT_THAT(sim::MessageOf([&] { (void)Play(agent, 3000); }), HasSubstr("restarted during the replay"));
}

TEST(ReplayDrive, RepeatsTheEndUntilTheAgentObeys) {
  FakeAgent agent;
  agent.ignores_end_commands = 3;
  (void)Play(agent, 100);
  EXPECT_EQ(agent.end_commands, 4);
  FakeAgent obstinate;
  obstinate.ignores_end_commands = 1000;
  EXPECT_THAT(sim::MessageOf([&] { (void)Play(obstinate, 100); }), HasSubstr("not ended its drive within 60 s"));
  EXPECT_NEAR(obstinate.end_commands, 120, 30);
}

TEST(ReplayDrive, RefusesAnAgentThatHasAlreadyEnded) {
  FakeAgent agent;
  agent.SendEndDrive();
  EXPECT_THAT(sim::MessageOf([&] { (void)Play(agent, 100); }), HasSubstr("already ended"));
}

TEST(ReplayDrive, KeepsTheRecordedPaceInRealTime) {
  FakeAgent agent;
  agent.packets_per_s = 1e6;
  const ReplaySummary summary = Play(agent, 2000, true);
  ASSERT_EQ(agent.sent_at_s.size(), 2000U);
  for (std::size_t i = 0; i < 2000; ++i) {
    ASSERT_NEAR(agent.sent_at_s[i] - agent.sent_at_s[0], static_cast<double>(i) * 1.327104e-3, 1e-6);
  }
  EXPECT_EQ(summary.packets_lost, 0);
  EXPECT_EQ(summary.frames_lost, 0);
}

TEST(ReplayDrive, CountsWhatASlowAgentLosesInRealTime) {
  FakeAgent agent;
  agent.packets_per_s = 300;
  const ReplaySummary summary = Play(agent, 2000, true);
  EXPECT_GT(agent.lost, 500);
  EXPECT_EQ(summary.packets_lost, agent.lost);
  EXPECT_EQ(agent.end_commands, 1);
}

}  // namespace
}  // namespace mapweld::replay
