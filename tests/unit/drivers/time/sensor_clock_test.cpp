// SPDX-License-Identifier: Apache-2.0
#include "drivers/time/sensor_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace mapweld::time {
namespace {

constexpr std::int64_t kHourUs = 3'600'000'000;

SensorClockOptions Receive(SensorClockOptions options) {
  options.mode = ClockMode::kReceive;
  return options;
}

TEST(SharedClock, CrossesTheHourWithoutAStep) {
  SensorClock clock(kLidarHourClock);
  constexpr std::int64_t kPacketUs = 1327;
  TimeNs last;
  for (std::int64_t us = kHourUs - 1'000'000; us < 3 * kHourUs; us += kPacketUs) {
    TimeNs t;
    ASSERT_EQ(clock.ToTime(static_cast<std::uint64_t>(us % kHourUs), {}, &t), Status::kOk);
    ASSERT_EQ(t.ns, us * 1000);
    last = t;
  }
  EXPECT_EQ(clock.counters().jumps, 0U);
  EXPECT_GT(last.ns, 2 * kHourUs * 1000);
}

TEST(SharedClock, CrossesTheWrapOfTheImuCounter) {
  SensorClock clock(kXsens100usClock);
  TimeNs before;
  TimeNs after;
  ASSERT_EQ(clock.ToTime(0xFFFFFFFFU, {}, &before), Status::kOk);
  ASSERT_EQ(clock.ToTime(24, {}, &after), Status::kOk);
  EXPECT_EQ((after - before).ns, 25 * 100'000);
}

TEST(SharedClock, GivesTwoSensorsWithOneReadingTheSameTime) {
  SensorClock imu(kXsens100usClock);
  SensorClock lidar(kLidarHourClock);
  // 5000 s after the common start the LiDAR's counter has wrapped once; the IMU tells it so.
  TimeNs imu_t;
  TimeNs lidar_t;
  ASSERT_EQ(imu.ToTime(50'000'000, {}, &imu_t), Status::kOk);
  lidar.Anchor(imu_t);
  ASSERT_EQ(lidar.ToTime(1'400'000'000, {}, &lidar_t), Status::kOk);
  EXPECT_EQ(lidar_t, imu_t);
}

TEST(SharedClock, RefusesTicksBeyondTheWrap) {
  SensorClock clock(kLidarHourClock);
  TimeNs t{7};
  EXPECT_EQ(clock.ToTime(kHourUs, {}, &t), Status::kOutOfRange);
  EXPECT_EQ(t.ns, 7);
  EXPECT_EQ(clock.counters().out_of_range, 1U);
}

TEST(SharedClock, KeepsTheTrueTimeOfAPacketThatCameLate) {
  SensorClock clock(kLidarHourClock);
  TimeNs t;
  ASSERT_EQ(clock.ToTime(2'000'000, {}, &t), Status::kOk);
  ASSERT_EQ(clock.ToTime(1'500'000, {}, &t), Status::kOk);
  EXPECT_EQ(t.ns, 1'500'000'000);
}

TEST(SharedClock, RefusesSingleJumpsBackwardsAndGoesOn) {
  SensorClock clock(kLidarHourClock);
  TimeNs t;
  ASSERT_EQ(clock.ToTime(10'000'000, {}, &t), Status::kOk);
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(clock.ToTime(static_cast<std::uint64_t>(i) * 70'000, {}, &t), Status::kStale);
    ASSERT_EQ(clock.ToTime(static_cast<std::uint64_t>(10'000'000 + i), {}, &t), Status::kOk);
    ASSERT_EQ(t.ns, (10'000'000 + i) * 1000LL);
  }
  EXPECT_EQ(clock.counters().jumps, 100U);
  EXPECT_EQ(clock.counters().resyncs, 0U);
}

TEST(SharedClock, BelievesARestartedSensorAfterConsistentReadings) {
  SensorClock clock(kXsens100usClock);
  TimeNs receive{1'000'000'000'000};
  TimeNs last;
  ASSERT_EQ(clock.ToTime(5'000'000, receive, &last), Status::kOk);  // 500 s
  int refused = 0;
  TimeNs t;
  for (std::uint64_t ticks = 0; ticks < 1000; ticks += 25) {
    receive = receive + DurationNs{2'500'000};
    const Status status = clock.ToTime(ticks, receive, &t);
    if (status == Status::kStale) {
      ++refused;
      continue;
    }
    ASSERT_EQ(status, Status::kOk);
    EXPECT_GT(t, last);
    EXPECT_LT((t - last).ns, 100'000'000) << "time goes on from where it was, not days later";
    last = t;
  }
  EXPECT_EQ(refused, SensorClock::kResyncSamples - 1);
  EXPECT_EQ(clock.counters().resyncs, 1U);
}

TEST(SharedClock, FindsTheRightTurnAfterALongSilence) {
  SensorClock clock(kLidarHourClock);
  TimeNs t;
  ASSERT_EQ(clock.ToTime(1'000'000, {0}, &t), Status::kOk);
  // 50 minutes without a packet look like 10 minutes backwards.
  const std::int64_t silence_us = 3'000'000'000;
  Status status = Status::kStale;
  for (std::int64_t us = silence_us; status == Status::kStale; us += 1327) {
    status = clock.ToTime(static_cast<std::uint64_t>(1'000'000 + us), {us * 1000 + 300'000}, &t);
    if (status == Status::kOk) {
      EXPECT_EQ(t.ns, (1'000'000 + us) * 1000);
    }
  }
  EXPECT_EQ(status, Status::kOk);
}

// A free-running sensor: its clock is off by `drift`, its readings arrive after a random delay of at least 0.2 ms.
struct Stream {
  double drift_ppm;
  std::mt19937 random{7};
  std::int64_t true_ns = 5'000'000'000'000;
  std::int64_t start_ns = true_ns;

  std::uint64_t Ticks() const {
    const double sensor_ns = static_cast<double>(true_ns - start_ns) * (1.0 + drift_ppm * 1e-6);
    return static_cast<std::uint64_t>(sensor_ns / 1000.0) + 1'234'567;
  }
  TimeNs Arrival() {
    std::exponential_distribution<double> delay(1.0 / 300'000.0);
    return {true_ns + 200'000 + static_cast<std::int64_t>(delay(random))};
  }
};

class FreeRunningClock : public testing::TestWithParam<double> {};

TEST_P(FreeRunningClock, StaysWithinAMillisecondAndNeverStepsBack) {
  Stream stream{.drift_ppm = GetParam()};
  SensorClock clock(Receive(kLidarHourClock));
  TimeNs last;
  double worst_ms = 0;
  constexpr std::int64_t kPeriodNs = 1'327'104;
  for (int i = 0; i < 1'000'000; ++i, stream.true_ns += kPeriodNs) {
    TimeNs t;
    ASSERT_EQ(clock.ToTime(stream.Ticks(), stream.Arrival(), &t), Status::kOk);
    ASSERT_GE(t, last);
    if (i > 3000) {  // settled
      ASSERT_NEAR(static_cast<double>((t - last).ns), static_cast<double>(kPeriodNs), 2000.0);
      worst_ms = std::max(worst_ms, std::abs(static_cast<double>(t.ns - stream.true_ns) * 1e-6));
    }
    last = t;
  }
  EXPECT_LT(worst_ms, 1.0);
  EXPECT_EQ(clock.counters().jumps, 0U);
}
INSTANTIATE_TEST_SUITE_P(Drift, FreeRunningClock, testing::Values(-100.0, 0.0, 100.0));

TEST(FreeRunningClock, CountsTheTurnsOfASilenceLongerThanTheCounter) {
  SensorClock clock(Receive(kLidarHourClock));
  TimeNs first;
  TimeNs second;
  ASSERT_EQ(clock.ToTime(100, {1'000'000'000}, &first), Status::kOk);
  const std::int64_t gap_us = 2 * kHourUs + 5'000'000;
  ASSERT_EQ(clock.ToTime(5'000'100, {1'000'000'000 + gap_us * 1000}, &second), Status::kOk);
  EXPECT_EQ((second - first).ns, gap_us * 1000);
}

TEST(FreeRunningClock, RefusesReadingsThatRunAhead) {
  SensorClock clock(Receive(kLidarHourClock));
  TimeNs t;
  ASSERT_EQ(clock.ToTime(100, {1'000'000'000}, &t), Status::kOk);
  EXPECT_EQ(clock.ToTime(60'000'000, {1'001'000'000}, &t), Status::kStale);
  EXPECT_EQ(clock.ToTime(2'000'100, {3'000'000'000}, &t), Status::kOk);
  EXPECT_EQ(t.ns, 3'000'000'000);
}

TEST(FreeRunningClock, GoesOnWhenTheSensorRestarts) {
  SensorClock clock(Receive(kXsens100usClock));
  TimeNs receive{1'000'000'000};
  TimeNs last;
  ASSERT_EQ(clock.ToTime(9'000'000, receive, &last), Status::kOk);
  TimeNs t;
  int accepted = 0;
  for (std::uint64_t ticks = 0; ticks < 1000; ticks += 25) {
    receive = receive + DurationNs{2'500'000};
    if (clock.ToTime(ticks, receive, &t) != Status::kOk) continue;
    ++accepted;
    EXPECT_GE(t, last);
    EXPECT_NEAR(static_cast<double>((receive - t).ns), 0.0, 1e6);
    last = t;
  }
  EXPECT_GT(accepted, 30);
}

// A log whose recorded times leap by centuries must not add up to more than 64 bits hold.
TEST(SharedClock, StaysFiniteWhenTheReceiveClockLeaps) {
  SensorClock clock(kLidarHourClock);
  TimeNs t;
  for (int round = 0; round < 100; ++round) {
    // Each round the counter falls back, and is believed after a few readings.
    for (std::uint64_t i = 0; i < 20; ++i) (void)clock.ToTime(3'000'000'000 + i, {0}, &t);
    for (std::uint64_t i = 0; i < 20; ++i) (void)clock.ToTime(2'000'000'000 + i, {9'000'000'000'000'000'000}, &t);
  }
  EXPECT_GT(clock.counters().resyncs, 50U);
  EXPECT_LT(t.ns, 1000 * SensorClock::kLongestSilence.ns);
}

}  // namespace
}  // namespace mapweld::time
