// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/xsens_codec.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

#include "drivers/can/xsens_table.hpp"
#include "tests/unit/drivers/can/xsens_frames.hpp"

namespace mapweld::can {
namespace {

using test::Frame;
using test::FrameAxes;
using test::FrameU32;
using test::Group;

// Pushes all frames; gives the number of samples, the last one in *sample.
template <class Frames>
int PushAll(XsensCodec* codec, const Frames& frames, sensor::ImuSample* sample) {
  int samples = 0;
  for (const CanFrame& frame : frames) samples += codec->Push(frame, sample) == Status::kOk ? 1 : 0;
  return samples;
}

TEST(XsensCodec, BuildsASampleInSiUnits) {
  XsensCodec codec({});
  sensor::ImuSample sample;
  ASSERT_EQ(PushAll(&codec, Group({.ticks = 12345, .counter = 9, .gyro = {512, -256, 1}, .accel = {-256, 128, 2511}}),
                    &sample),
            1);
  EXPECT_EQ(sample.t.ns, 1'234'500'000);
  EXPECT_DOUBLE_EQ(sample.gyro_body.x(), 1.0);
  EXPECT_DOUBLE_EQ(sample.gyro_body.y(), -0.5);
  EXPECT_DOUBLE_EQ(sample.gyro_body.z(), 1.0 / 512);
  EXPECT_DOUBLE_EQ(sample.accel_body.x(), -1.0);
  EXPECT_DOUBLE_EQ(sample.accel_body.y(), 0.5);
  EXPECT_NEAR(sample.accel_body.z(), 9.81, 0.002);
  EXPECT_FALSE(sample.clipped);
  EXPECT_EQ(codec.Rejected(), 0U);
}

TEST(XsensCodec, ReadsSampleTimeInMicrosecondsWhenToldSo) {
  XsensCodec codec({.sample_time_unit = SampleTimeUnit::k1us});
  sensor::ImuSample sample;
  ASSERT_EQ(PushAll(&codec, Group({.ticks = 12345}), &sample), 1);
  EXPECT_EQ(sample.t.ns, 12'345'000);
}

TEST(XsensCodec, TellsTheUnitOfSampleTimeFromItsSteps) {
  for (const int hz : {5, 10, 100, 200, 400}) {
    for (const std::uint32_t ticks_per_s : {10'000U, 1'000'000U}) {
      XsensCodec codec({.sample_time_unit = SampleTimeUnit::kDetect});
      sensor::ImuSample sample;
      const std::uint32_t step = ticks_per_s / static_cast<std::uint32_t>(hz);
      int samples = 0;
      TimeNs last;
      for (std::uint32_t k = 0; k < 20; ++k) {
        const int got =
            PushAll(&codec, Group({.ticks = 0xFFFFFF00U + step * k, .counter = static_cast<std::uint16_t>(65'530 + k)}),
                    &sample);
        if (samples > 0) {
          ASSERT_EQ((sample.t - last).ns, 1'000'000'000 / hz) << hz << " Hz in " << ticks_per_s;
        }
        samples += got;
        last = sample.t;
      }
      EXPECT_EQ(samples, 20 - XsensCodec::kDetectGroups);
      EXPECT_EQ(codec.counters().undecided, static_cast<std::uint64_t>(XsensCodec::kDetectGroups));
      EXPECT_EQ(codec.Rejected(), 0U);
    }
  }
}

TEST(XsensCodec, DecidesTheUnitOnlyOnGroupsThatFollowEachOther) {
  XsensCodec codec({.sample_time_unit = SampleTimeUnit::kDetect});
  sensor::ImuSample sample;
  int samples = 0;
  for (std::uint32_t k = 0; k < 60; ++k) {  // at first every 8th group is lost, and two steps of 1250 are 2500
    if (k % 8 == 7 && k < 40) continue;
    samples += PushAll(&codec, Group({.ticks = 1250 * k, .counter = static_cast<std::uint16_t>(k)}), &sample);
  }
  ASSERT_GT(samples, 0);
  EXPECT_EQ(sample.t.ns, 59LL * 1250 * 100'000);
}

TEST(XsensCodec, AcceptsAnyOrderAfterSampleTime) {
  std::array<int, 4> order{1, 2, 3, 4};
  do {
    XsensCodec codec({});
    sensor::ImuSample sample;
    int samples = 0;
    for (std::uint32_t k = 0; k < 5; ++k) {
      const auto group = Group({.ticks = 25 * k,
                                .counter = static_cast<std::uint16_t>(k),
                                .gyro = {static_cast<int>(k), 0, 0},
                                .accel = {static_cast<int>(k), 0, 0}});
      samples += codec.Push(group[0], &sample) == Status::kOk ? 1 : 0;
      for (const int i : order)
        samples += codec.Push(group[static_cast<std::size_t>(i)], &sample) == Status::kOk ? 1 : 0;
      ASSERT_EQ(sample.gyro_body.x() * 512, k);
      ASSERT_EQ(sample.accel_body.x() * 256, k);
    }
    EXPECT_EQ(samples, 5);
    EXPECT_EQ(codec.Rejected(), 0U);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(XsensCodec, NeedsNoStatusWord) {
  XsensCodec codec({});
  auto group = Group({.ticks = 100});
  std::swap(group[2], group[4]);
  sensor::ImuSample sample;
  EXPECT_EQ(PushAll(&codec, std::span(group).first(4), &sample), 1);
}

TEST(XsensCodec, MarksClippingOfTheInertialAxesOnly) {
  for (unsigned bit = 0; bit < 32; ++bit) {
    XsensCodec codec({});
    sensor::ImuSample sample;
    ASSERT_EQ(PushAll(&codec, Group({.ticks = 1, .status = 1U << bit}), &sample), 1);
    EXPECT_EQ(sample.clipped, bit >= 8 && bit <= 13) << bit;
  }
}

TEST(XsensCodec, RefusesEveryWrongLengthOfEveryIdentifier) {
  for (std::uint32_t id = 0; id <= 0x7FF; ++id) {
    const XsensMessage* message = FindXsensMessage(id);
    for (std::uint8_t dlc = 0; dlc <= 8; ++dlc) {
      XsensCodec codec({});
      sensor::ImuSample sample;
      // An open group, so that needed messages find their place.
      ASSERT_EQ(codec.Push(FrameU32(0x005, 1), &sample), Status::kNotReady);
      CanFrame frame;
      frame.id = id;
      frame.dlc = dlc;
      const Status status = codec.Push(frame, &sample);
      if (message == nullptr) {
        ASSERT_EQ(status, Status::kBadInput);
        ASSERT_EQ(codec.counters().unknown_id, 1U);
      } else if (dlc != message->dlc) {
        ASSERT_EQ(status, Status::kBadInput) << id << " " << int{dlc};
        ASSERT_EQ(codec.counters().wrong_dlc, 1U);
      } else if (message->field == XsensField::kNone) {
        ASSERT_EQ(status, Status::kEmpty);
        ASSERT_EQ(codec.counters().unused, 1U);
      } else {
        ASSERT_EQ(status, Status::kNotReady) << id;
        ASSERT_EQ(codec.Rejected(), id == 0x005 ? 1U : 0U);
      }
    }
  }
}

TEST(XsensCodec, RefusesRemoteExtendedAndErrorFrames) {
  XsensCodec codec({});
  sensor::ImuSample sample;
  CanFrame frame = FrameU32(0x005, 1);
  frame.remote = true;
  EXPECT_EQ(codec.Push(frame, &sample), Status::kBadInput);
  frame.extended = true;
  EXPECT_EQ(codec.Push(frame, &sample), Status::kBadInput);
  frame.error = true;
  EXPECT_EQ(codec.Push(frame, &sample), Status::kBadInput);
  EXPECT_EQ(codec.counters().remote, 1U);
  EXPECT_EQ(codec.counters().extended, 1U);
  EXPECT_EQ(codec.counters().error_frames, 1U);
}

TEST(XsensCodec, RefusesValuesNoSensorCanMeasure) {
  struct Case {
    std::uint32_t id;
    int limit;
  };
  for (const Case c : {Case{0x032, 35 * 512}, Case{0x034, 100 * 256}}) {
    for (const int value : {c.limit, -c.limit, c.limit + 1, -c.limit - 1, 32767, -32768}) {
      XsensCodec codec({});
      sensor::ImuSample sample;
      auto group = Group({.ticks = 1});
      for (CanFrame& frame : group) {
        if (frame.id == c.id) frame = FrameAxes(c.id, 0, value, 0);
      }
      const bool good = std::abs(value) <= c.limit;
      EXPECT_EQ(PushAll(&codec, group, &sample), good ? 1 : 0) << c.id << " " << value;
      EXPECT_EQ(codec.counters().out_of_range, good ? 0U : 1U);
    }
  }
}

TEST(XsensCodec, DropsAGroupWithAMessageMissing) {
  for (const std::size_t missing : {1U, 3U, 4U}) {
    XsensCodec codec({});
    sensor::ImuSample sample;
    int samples = 0;
    for (std::uint32_t k = 0; k < 10; ++k) {
      const auto group = Group({.ticks = 25 * k, .counter = static_cast<std::uint16_t>(k)});
      for (std::size_t i = 0; i < group.size(); ++i) {
        if (k == 5 && i == missing) continue;
        samples += codec.Push(group[i], &sample) == Status::kOk ? 1 : 0;
      }
    }
    EXPECT_EQ(samples, 9) << missing;
    EXPECT_EQ(codec.counters().torn_groups, 1U);
  }
}

TEST(XsensCodec, DropsAGroupInsideWhichThePortLostFrames) {
  XsensCodec codec({});
  sensor::ImuSample sample;
  const auto one = Group({.ticks = 25, .counter = 1});
  auto two = Group({.ticks = 50, .counter = 2});
  two[3].gap = true;
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NE(codec.Push(one[i], &sample), Status::kOk);
  for (std::size_t i = 3; i < 5; ++i) EXPECT_NE(codec.Push(two[i], &sample), Status::kOk);
  EXPECT_EQ(codec.counters().torn_groups, 1U);
  EXPECT_EQ(PushAll(&codec, Group({.ticks = 75, .counter = 3}), &sample), 1);
}

// Neither stamps nor the port tell of the loss here; the frames themselves have to.
TEST(XsensCodec, SeesFromTheFramesThatTwoGroupsWereJoined) {
  for (const std::size_t kept :
       {1U, 2U, 3U}) {  // frames of group 5 before the loss, which ends after SampleTime of group 6
    XsensCodec codec({});
    sensor::ImuSample sample;
    for (std::uint32_t k = 0; k < 10; ++k) {
      const int mark = static_cast<int>(k);
      const auto group = Group(
          {.ticks = 25 * k, .counter = static_cast<std::uint16_t>(k), .gyro = {mark, 0, 0}, .accel = {mark, 0, 0}});
      for (std::size_t i = 0; i < group.size(); ++i) {
        if ((k == 5 && i >= kept) || (k == 6 && i == 0)) continue;
        if (codec.Push(group[i], &sample) != Status::kOk) continue;
        ASSERT_EQ(sample.t.ns, k * 2'500'000LL) << kept;
        ASSERT_EQ(sample.gyro_body.x() * 512, mark);
      }
    }
    EXPECT_EQ(codec.counters().samples, 8U) << kept;
    EXPECT_EQ(codec.counters().torn_groups, 1U) << kept;
  }
}

TEST(XsensCodec, KeepsAGroupThatABusyBusDelayed) {
  XsensCodec codec({});
  sensor::ImuSample sample;
  int samples = 0;
  for (std::uint32_t k = 0; k < 10; ++k) {
    auto group = Group({.ticks = 25 * k,
                        .counter = static_cast<std::uint16_t>(k),
                        .gyro = {static_cast<int>(k), 0, 0},
                        .receive_ns = 1'000'000'000 + k * 2'500'000LL});
    // The end of group 5 comes more than a period late, right before group 6.
    if (k == 5) group[4].receive = {group[0].receive.ns + 2'600'000};
    const int got = PushAll(&codec, group, &sample);
    EXPECT_EQ(got, k == 5 ? 0 : (k == 6 ? 2 : 1)) << k;
    samples += got;
  }
  EXPECT_EQ(samples, 10);
  EXPECT_EQ(codec.Rejected(), 0U);
}

TEST(XsensCodec, DropsAGroupThatTookItsEndFromTheNext) {
  XsensCodec codec({});
  sensor::ImuSample sample;
  int samples = 0;
  for (std::uint32_t k = 0; k < 10; ++k) {
    const auto group = Group(
        {.ticks = 25 * k, .counter = static_cast<std::uint16_t>(k), .receive_ns = 1'000'000'000 + k * 2'500'000LL});
    for (std::size_t i = 0; i < group.size(); ++i) {
      if ((k == 5 && i == 4) || (k == 6 && i < 4)) continue;  // lost without a trace
      samples += codec.Push(group[i], &sample) == Status::kOk ? 1 : 0;
    }
  }
  EXPECT_EQ(samples, 8);
  EXPECT_EQ(codec.counters().torn_groups, 1U);
}

TEST(XsensCodec, CrossesTheWrapsOfBothCounters) {
  XsensCodec codec({});
  sensor::ImuSample sample;
  TimeNs last;
  int samples = 0;
  std::uint32_t ticks = 0xFFFFFFFFU - 25 * 50;
  std::uint16_t counter = 0xFFFF - 30;
  for (int k = 0; k < 100; ++k, ticks += 25, ++counter) {
    samples += PushAll(&codec, Group({.ticks = ticks, .counter = counter}), &sample);
    if (k > 0) {
      EXPECT_EQ((sample.t - last).ns, 2'500'000);
    }
    last = sample.t;
  }
  EXPECT_EQ(samples, 100);
}

TEST(XsensCodec, RecoversWhenTheSensorRestarts) {
  XsensCodec codec({});
  sensor::ImuSample sample;
  std::int64_t receive_ns = 1'000'000'000;
  int before = 0;
  for (std::uint32_t k = 0; k < 100; ++k, receive_ns += 2'500'000) {
    before += PushAll(
        &codec,
        Group({.ticks = 900'000 + 25 * k, .counter = static_cast<std::uint16_t>(700 + k), .receive_ns = receive_ns}),
        &sample);
  }
  EXPECT_EQ(before, 100);
  TimeNs last = sample.t;
  int after = 0;
  for (std::uint32_t k = 0; k < 200; ++k, receive_ns += 2'500'000) {
    const int got = PushAll(
        &codec, Group({.ticks = 25 * k, .counter = static_cast<std::uint16_t>(k), .receive_ns = receive_ns}), &sample);
    after += got;
    if (got == 0) continue;
    EXPECT_GT(sample.t, last);
    EXPECT_LT((sample.t - last).ns, 100'000'000);
    last = sample.t;
  }
  EXPECT_GT(after, 180) << "data again within 50 ms";
}

TEST(XsensCodec, NeverGoesBackInTime) {
  XsensCodec codec({});
  sensor::ImuSample sample;
  EXPECT_EQ(PushAll(&codec, Group({.ticks = 1000, .counter = 1}), &sample), 1);
  EXPECT_EQ(PushAll(&codec, Group({.ticks = 1000, .counter = 2}), &sample), 0);
  EXPECT_EQ(PushAll(&codec, Group({.ticks = 975, .counter = 3}), &sample), 0);
  EXPECT_EQ(PushAll(&codec, Group({.ticks = 1025, .counter = 2}), &sample), 1);
}

TEST(XsensTable, HoldsEveryWantedIdentifier) {
  for (const std::uint32_t id : kXsensWantedIds) {
    ASSERT_NE(FindXsensMessage(id), nullptr);
    EXPECT_NE(FindXsensMessage(id)->field, XsensField::kNone);
  }
  EXPECT_EQ(std::ranges::count_if(kXsensMessages, [](const XsensMessage& m) { return m.field != XsensField::kNone; }),
            static_cast<std::ptrdiff_t>(kXsensWantedIds.size()));
}

}  // namespace
}  // namespace mapweld::can
