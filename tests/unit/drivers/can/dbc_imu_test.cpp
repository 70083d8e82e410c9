// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <linux/can.h>

#include <numbers>
#include <string>

#include "drivers/can/dbc_imu_codec.hpp"
#include "tests/unit/drivers/can/dbc_text.hpp"
#include "tests/unit/drivers/can/xsens_frames.hpp"

namespace mapweld::can {
namespace {

using test::FrameAxes;
using test::kDbc;

constexpr double kDeg = std::numbers::pi / 180.0;

TEST(Dbc, FindsASignalByName) {
  DbcSignal signal;
  ASSERT_EQ(FindDbcSignal(kDbc, "gyroY", &signal), Status::kOk);
  EXPECT_EQ(signal.id, 50U);
  EXPECT_FALSE(signal.extended);
  EXPECT_EQ(signal.dlc, 6);
  EXPECT_TRUE(signal.big_endian && signal.is_signed);
  EXPECT_EQ(signal.unit, "rad/s");
  ASSERT_EQ(FindDbcSignal(kDbc, "ay", &signal), Status::kOk);
  EXPECT_EQ(signal.id, 2364539904U & CAN_EFF_MASK);
  EXPECT_TRUE(signal.extended);
  EXPECT_DOUBLE_EQ(signal.offset, -5.12);
}

TEST(Dbc, RefusesWhatItCannotRead) {
  DbcSignal signal;
  EXPECT_EQ(FindDbcSignal(kDbc, "nothing", &signal), Status::kEmpty);
  EXPECT_EQ(FindDbcSignal(kDbc, "twice", &signal), Status::kEmpty);
  EXPECT_EQ(FindDbcSignal(kDbc, "tooLong", &signal), Status::kBadInput) << "beyond its message";
  EXPECT_EQ(FindDbcSignal(kDbc, "switched", &signal), Status::kBadInput) << "multiplexed";
  EXPECT_EQ(FindDbcSignal("SG_ a : 0|8@1+ (1,0) [0|1] \"\" E", "a", &signal), Status::kBadInput) << "of no message";
  for (const char* line :
       {"0|0@1+ (1,0) [0|1] \"\"", "0|33@1+ (1,0) [0|1] \"\"", "0|8@2+ (1,0) [0|1] \"\"", "0|8@1 (1,0) [0|1] \"\"",
        "0|8@1+ (nan,0) [0|1] \"\"", "0|8@1+ (1,inf) [0|1] \"\"", "0|8@1+ (1,0) [0|1] \"", "0|8@1+ (1,0)",
        "64|8@1+ (1,0) [0|1] \"\"", "-1|8@1+ (1,0) [0|1] \"\""}) {
    const std::string text = std::string("BO_ 1 M: 8 N\n SG_ a : ") + line;
    EXPECT_EQ(FindDbcSignal(text, "a", &signal), Status::kBadInput) << line;
  }
  EXPECT_EQ(FindDbcSignal("BO_ 2048 M: 8 N\n SG_ a : 0|8@1+ (1,0) [0|1] \"\"", "a", &signal), Status::kBadInput);
  EXPECT_EQ(FindDbcSignal("BO_ 1 M: 9 N\n SG_ a : 0|8@1+ (1,0) [0|1] \"\"", "a", &signal), Status::kBadInput);
}

TEST(Dbc, ReadsEveryLengthAtEveryPlaceInBothByteOrders) {
  for (unsigned length = 1; length <= 32; ++length) {
    for (unsigned first = 0; first + length <= 64; ++first) {
      for (const bool big : {false, true}) {
        const DbcSignal signal{.dlc = 8,
                               .start = static_cast<std::uint8_t>(big ? first / 8 * 8 + 7 - first % 8 : first),
                               .length = static_cast<std::uint8_t>(length),
                               .big_endian = big,
                               .unit = {}};
        CanFrame frame;
        frame.dlc = 8;
        const std::uint64_t raw = 0xA5C3961E & ((std::uint64_t{1} << length) - 1);
        for (unsigned k = 0; k < length; ++k) {  // bit k of the value, counted from its lowest
          const unsigned place = big ? first + length - 1 - k : first + k;
          const unsigned in_byte = big ? 7 - place % 8 : place % 8;
          frame.data[place / 8] = static_cast<std::uint8_t>(frame.data[place / 8] | (raw >> k & 1) << in_byte);
        }
        ASSERT_EQ(DbcValue(signal, frame), static_cast<double>(raw)) << length << " bits at " << first;
      }
    }
  }
}

CanFrame Stamped(CanFrame frame, std::int64_t t_ns) {
  frame.receive = {t_ns};
  return frame;
}

TEST(DbcImu, BuildsSamplesOfTwoMotorolaMessages) {
  DbcImuCodec codec;
  ASSERT_EQ(codec.Configure(kDbc, test::kMotorolaNames), Status::kOk);
  ASSERT_EQ(codec.wanted_ids().size(), 2U);
  sensor::ImuSample sample;
  EXPECT_EQ(codec.Push(Stamped(FrameAxes(50, 512, -256, 1), 1'000), &sample), Status::kNotReady);
  ASSERT_EQ(codec.Push(Stamped(FrameAxes(52, -256, 128, 2511), 2'000), &sample), Status::kOk);
  EXPECT_EQ(sample.t.ns, 1'000);
  EXPECT_DOUBLE_EQ(sample.gyro_body.x(), 1.0);
  EXPECT_DOUBLE_EQ(sample.gyro_body.y(), -0.5);
  EXPECT_DOUBLE_EQ(sample.accel_body.x(), -1.0);
  EXPECT_NEAR(sample.accel_body.z(), 9.81, 0.002);
}

TEST(DbcImu, BuildsSamplesOfOneIntelMessageInOtherUnits) {
  DbcImuCodec codec;
  ASSERT_EQ(codec.Configure(kDbc, test::kIntelNames), Status::kOk);
  ASSERT_EQ(codec.wanted_ids().size(), 1U);
  EXPECT_EQ(codec.wanted_ids()[0], (2364539904U & CAN_EFF_MASK) | CAN_EFF_FLAG);
  std::uint64_t bits = 0;
  const auto put = [&](std::uint64_t raw, unsigned at) { bits |= (raw & 0x3FF) << at; };
  put(20, 0);
  put(1024 - 40, 10);
  put(512 + 100, 50);
  put(512, 30);
  put(512, 40);
  CanFrame frame;
  frame.id = 2364539904U & CAN_EFF_MASK;
  frame.extended = true;
  frame.dlc = 8;
  frame.receive = {5};
  for (std::size_t i = 0; i < 8; ++i) frame.data[i] = static_cast<std::uint8_t>(bits >> (8 * i));
  sensor::ImuSample sample;
  ASSERT_EQ(codec.Push(frame, &sample), Status::kOk);
  EXPECT_NEAR(sample.gyro_body.x(), 10 * kDeg, 1e-12);
  EXPECT_NEAR(sample.gyro_body.y(), -20 * kDeg, 1e-12);
  EXPECT_NEAR(sample.accel_body.x(), 0.0, 1e-9);
  EXPECT_NEAR(sample.accel_body.z(), 9.80665, 1e-9);
  EXPECT_EQ(codec.Push(frame, &sample), Status::kStale) << "time must go forward";
}

TEST(DbcImu, NeverJoinsFramesOfTwoSamples) {
  DbcImuCodec codec;
  ASSERT_EQ(codec.Configure(kDbc, test::kMotorolaNames), Status::kOk);
  sensor::ImuSample sample;
  EXPECT_EQ(codec.Push(Stamped(FrameAxes(52, 1, 1, 1), 1), &sample), Status::kNotReady) << "before any sample";
  EXPECT_EQ(codec.Push(Stamped(FrameAxes(50, 1, 1, 1), 2), &sample), Status::kNotReady);
  EXPECT_EQ(codec.Push(Stamped(FrameAxes(50, 2, 2, 2), 3), &sample), Status::kNotReady) << "its acceleration is lost";
  CanFrame after_gap = Stamped(FrameAxes(52, 3, 3, 3), 4);
  after_gap.gap = true;
  EXPECT_EQ(codec.Push(after_gap, &sample), Status::kNotReady);
  EXPECT_EQ(codec.counters().torn, 2U);
  EXPECT_EQ(codec.counters().samples, 0U);
  EXPECT_EQ(codec.Push(Stamped(FrameAxes(50, 4, 4, 4), 5), &sample), Status::kNotReady);
  EXPECT_EQ(codec.Push(Stamped(FrameAxes(52, 4, 4, 4), 6), &sample), Status::kOk);
}

TEST(DbcImu, CountsEveryRefusalByCause) {
  DbcImuCodec codec;
  ASSERT_EQ(codec.Configure(kDbc, test::kMotorolaNames), Status::kOk);
  sensor::ImuSample sample;
  for (std::uint32_t id = 0; id <= 0x7FF; ++id) {
    for (std::uint8_t dlc = 0; dlc <= 8; ++dlc) {
      CanFrame frame;
      frame.id = id;
      frame.dlc = dlc;
      const bool known = id == 50 || id == 52;
      ASSERT_EQ(codec.Push(frame, &sample) == Status::kBadInput, !known || dlc != 6) << id << " " << int{dlc};
      frame.extended = true;
      ASSERT_EQ(codec.Push(frame, &sample), Status::kBadInput);
    }
  }
  EXPECT_EQ(codec.counters().wrong_dlc, 2U * 8);
  CanFrame remote = FrameAxes(50, 0, 0, 0);
  remote.remote = true;
  EXPECT_EQ(codec.Push(remote, &sample), Status::kBadInput);
  CanFrame error = FrameAxes(50, 0, 0, 0);
  error.error = true;
  EXPECT_EQ(codec.Push(error, &sample), Status::kBadInput);
  EXPECT_EQ(codec.counters().error_frames, 1U);
}

TEST(DbcImu, RefusesNamesAndUnitsThatMakeNoImu) {
  DbcImuCodec codec;
  EXPECT_EQ(codec.Configure(kDbc, "gyroX,gyroY,gyroZ,accX,accY"), Status::kBadInput);
  EXPECT_EQ(codec.Configure(kDbc, "gyroX,gyroY,gyroZ,accX,accY,accZ,"), Status::kBadInput);
  EXPECT_EQ(codec.Configure(kDbc, "gyroX,gyroY,gyroZ,accX,accY,nothing"), Status::kEmpty);
  EXPECT_EQ(codec.Configure(kDbc, "accX,gyroY,gyroZ,accX,accY,accZ"), Status::kBadInput) << "m/s^2 is no turn rate";
  EXPECT_EQ(codec.Configure(kDbc, "gyroX,gyroY,gyroZ,accX,accY,celsius"), Status::kBadInput);
}

}  // namespace
}  // namespace mapweld::can
