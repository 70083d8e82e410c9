// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/xsens_start.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <tuple>

#include "drivers/can/xsens_codec.hpp"
#include "tests/unit/drivers/can/xsens_frames.hpp"

namespace mapweld::can {
namespace {

// A vehicle that starts somehow: its IMU's groups, with a bus in between that delays and loses some.
class Start {
 public:
  explicit Start(unsigned seed) : random_(seed) {
    ticks_ = static_cast<std::uint32_t>(random_());
    counter_ = static_cast<std::uint16_t>(random_());
    const double heading = Uniform(0, 2 * std::numbers::pi);
    const double tilt = Uniform(0, 0.6);
    gravity_ = {std::sin(tilt) * std::cos(heading), std::sin(tilt) * std::sin(heading), std::cos(tilt)};
  }
  double Uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  XsensGroup Next(double hz, std::int64_t tick_ns, bool swapped) {
    do {
      now_s_ += 1.0 / hz;
      ticks_ = begin_ticks_ + static_cast<std::uint32_t>(std::llround(now_s_ * 1e9 / static_cast<double>(tick_ns)));
      ++counter_;
    } while (Uniform(0, 1) < 0.02);  // lost
    XsensGroup group;
    group.sample_time_ticks = ticks_;
    group.counter = counter_;
    // A frame waits for the bus, now and then for long, but frames never overtake each other.
    const double delay_s = Uniform(0, 1) < 0.03 ? Uniform(0, 0.02) : Uniform(0, 0.0005);
    received_s_ = std::max(received_s_, now_s_ + delay_s);
    group.first_receive = {static_cast<std::int64_t>(received_s_ * 1e9) + 1'000'000'000};
    group.stamped = Uniform(0, 1) > 0.05;
    for (std::size_t i = 0; i < 3; ++i) {
      const double accel = 9.81 * gravity_[i] + Uniform(-1.5, 1.5);  // engine and braking
      const double turn = Uniform(-0.6, 0.6);
      group.accel[i] = static_cast<std::int16_t>(std::lround(accel * 256));
      group.gyro[i] = static_cast<std::int16_t>(std::lround(turn * 512));
    }
    if (swapped) std::swap(group.gyro, group.accel);
    return group;
  }
  [[nodiscard]] double now_s() const { return now_s_; }

 private:
  std::mt19937 random_;
  std::uint32_t begin_ticks_ = 0xFFFF'FF00;
  std::uint32_t ticks_ = 0;
  std::uint16_t counter_ = 0;
  double now_s_ = 0;
  double received_s_ = 0;
  std::array<double, 3> gravity_{};
};

TEST(XsensStart, DecidesAThousandStartsWithinTwoSecondsAndNeverWrong) {
  constexpr std::array kRates{5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 400.0, 800.0, 1000.0};
  double latest_s = 0;
  for (unsigned run = 0; run < 1000; ++run) {
    Start start(run);
    const double hz = kRates[run % kRates.size()];
    const std::int64_t tick_ns = run / kRates.size() % 2 == 0 ? 100'000 : 1'000;
    const bool swapped = run / (2 * kRates.size()) % 2 != 0;
    XsensStart detector(SampleTimeUnit::kDetect, InertialOrder::kDetect);
    while (!detector.Push(start.Next(hz, tick_ns, swapped))) ASSERT_LT(start.now_s(), 30.0) << hz;
    ASSERT_EQ(detector.unit(), tick_ns == 1'000 ? SampleTimeUnit::k1us : SampleTimeUnit::k100us) << hz;
    ASSERT_EQ(detector.swapped(), swapped) << hz;
    if (hz >= 20) latest_s = std::max(latest_s, start.now_s());
  }
  EXPECT_LT(latest_s, 2.0) << "below 20 Hz nine groups alone take half a second or more";
  std::printf("latest decision of the starts at 20 Hz and more: %.3f s\n", latest_s);
}

TEST(XsensStart, HearsNoStampsAndStillTellsWhatTheTicksTell) {
  for (const auto& [step, unit] : {std::pair(25U, SampleTimeUnit::k100us),
                                   {2000U, SampleTimeUnit::k100us},
                                   {2500U, SampleTimeUnit::k1us},
                                   {200'000U, SampleTimeUnit::k1us}}) {
    XsensStart detector(SampleTimeUnit::kDetect, InertialOrder::kAsNamed);
    XsensGroup group;
    group.stamped = false;
    int groups = 0;
    do {
      group.sample_time_ticks += step;
      ++group.counter;
      ASSERT_LT(++groups, 20);
    } while (!detector.Push(group));
    EXPECT_EQ(detector.unit(), unit) << step;
    EXPECT_EQ(groups, XsensStart::kGroups + 1);
  }
}

TEST(XsensStart, BelievesNeitherOrderOfASensorThatFeelsNoGravity) {
  XsensStart detector(SampleTimeUnit::k100us, InertialOrder::kDetect);
  XsensGroup group;
  for (const int length : {0, 500, 25'000}) {  // nothing, a fifth of a g, ten times too much
    for (int i = 0; i < 1000; ++i) {
      group.sample_time_ticks += 25;
      ++group.counter;
      group.accel = {0, 0, static_cast<std::int16_t>(length)};
      ASSERT_FALSE(detector.Push(group)) << length;
    }
  }
}

TEST(XsensCodec, ReadsSwappedHighRateMessagesTheRightWayRound) {
  XsensIds ids;
  ASSERT_EQ(XsensIds::Parse("005,006,011,061,062", &ids), Status::kOk);
  for (const bool swapped : {false, true}) {
    XsensCodec codec(
        {.ids = ids, .sample_time_unit = SampleTimeUnit::kDetect, .inertial_order = InertialOrder::kDetect});
    sensor::ImuSample sample;
    int samples = 0;
    for (std::uint32_t k = 0; k < 50; ++k) {
      for (CanFrame frame : test::Group({.ticks = 25 * k,
                            .counter = static_cast<std::uint16_t>(k),
                            .gyro = {0, 0, 51},
                            .accel = {10, 0, 2511}})) {
        if (frame.id == 0x032) frame.id = swapped ? 0x062 : 0x061;
        if (frame.id == 0x034) frame.id = swapped ? 0x061 : 0x062;
        if (codec.Push(frame, &sample) != Status::kOk) continue;
        ++samples;
        ASSERT_NEAR(sample.accel_body.z(), 9.81, 0.01) << "from the first sample on";
        ASSERT_NEAR(sample.gyro_body.z(), 0.1, 0.01);
      }
    }
    EXPECT_EQ(samples, 50 - XsensCodec::kDetectGroups);
    EXPECT_EQ(codec.start().swapped(), swapped);
    EXPECT_EQ(codec.Rejected(), 0U);
  }
}

TEST(XsensCodec, TakesTheLimitsOfWhatAMessageTurnedOutToBe) {
  XsensCodec codec({.inertial_order = InertialOrder::kSwapped});
  sensor::ImuSample sample;
  int samples = 0;
  // 0x032 holds the acceleration: 90 m/s^2 of it are less than 100, though as a turn they would be more than 35 rad/s.
  for (const CanFrame& frame : test::Group({.ticks = 1, .gyro = {0, 0, 90 * 256}, .accel = {0, 0, 512}})) {
    samples += codec.Push(frame, &sample) == Status::kOk ? 1 : 0;
  }
  ASSERT_EQ(samples, 1);
  EXPECT_DOUBLE_EQ(sample.accel_body.z(), 90.0);
  EXPECT_DOUBLE_EQ(sample.gyro_body.z(), 1.0);
}

}  // namespace
}  // namespace mapweld::can
