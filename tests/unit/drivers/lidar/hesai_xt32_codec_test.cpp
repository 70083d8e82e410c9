// SPDX-License-Identifier: Apache-2.0
#include "drivers/lidar/hesai_xt32_codec.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "tests/unit/drivers/lidar/hesai_packet.hpp"

namespace mapweld::lidar {
namespace {

using test::HesaiBuilder;

constexpr double kDeg = std::numbers::pi / 180.0;

class HesaiXt32Test : public testing::Test {
 protected:
  Status Decode(HesaiBuilder& builder) { return codec_.Decode(builder.bytes(), {}, packet_.get()); }

  HesaiXt32Codec codec_;
  std::unique_ptr<sensor::LidarPacket> packet_ = std::make_unique<sensor::LidarPacket>();
};

TEST_F(HesaiXt32Test, PutsEachChannelWhereTheManualSays) {
  for (std::size_t channel = 0; channel < 32; ++channel) {
    HesaiBuilder builder;
    builder.Rotate(9000, 0).Return(0, channel, 2500, 77);  // 90 degrees is to the right of the sensor
    ASSERT_EQ(Decode(builder), Status::kOk);
    ASSERT_EQ(packet_->points.size(), 1U);
    const sensor::LidarPoint& point = packet_->points[0];
    const double elevation = (15.0 - static_cast<double>(channel)) * kDeg;
    EXPECT_NEAR(point.x, 0.0, 1e-5);
    EXPECT_NEAR(point.y, -10.0 * std::cos(elevation), 1e-5);
    EXPECT_NEAR(point.z, 10.0 * std::sin(elevation), 1e-5);
    EXPECT_EQ(point.intensity, 77.0F);
    EXPECT_EQ(point.ring, 31 - channel);
  }
}

TEST_F(HesaiXt32Test, UsesTheSensorsOwnAngles) {
  BeamTable own;
  own.beams = 32;
  for (std::size_t i = 0; i < 32; ++i) {
    own.elevation_deg[i] = static_cast<double>(i);
    own.azimuth_deg[i] = 1.5;
  }
  codec_.SetAngles(own);
  HesaiBuilder builder;
  builder.Rotate(1000, 0).Return(0, 20, 2500);
  ASSERT_EQ(Decode(builder), Status::kOk);
  const sensor::LidarPoint& point = packet_->points[0];
  EXPECT_NEAR(std::atan2(-double{point.y}, double{point.x}) / kDeg, 11.5, 1e-4);
  EXPECT_NEAR(std::asin(double{point.z} / 10.0) / kDeg, 20.0, 1e-4);
  EXPECT_EQ(point.ring, 20);
}

TEST_F(HesaiXt32Test, StampsEveryFiring) {
  HesaiBuilder builder;
  builder.Rotate(0, 18).Everywhere(1000).Microseconds(500'000);
  ASSERT_EQ(Decode(builder), Status::kOk);
  ASSERT_EQ(packet_->points.size(), 256U);
  EXPECT_EQ(packet_->t.ns, (20 * 60 + 30) * 1'000'000'000LL + 500'000'000 + 6'000 - 7 * 50'000);
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_EQ(packet_->points[i].dt_ns, static_cast<int>(i / 32) * 50'000 + static_cast<int>(i % 32) * 1'512);
  }
}

TEST_F(HesaiXt32Test, GivesBothReturnsOfADualPacketOnce) {
  HesaiBuilder builder(0x39);
  builder.Rotate(100, 18, 2);
  builder.Return(2, 5, 1000).Return(3, 5, 1000);  // the same return twice
  builder.Return(4, 3, 1000).Return(5, 3, 1200);  // two returns
  builder.Return(7, 3, 1200);                     // only a second one
  ASSERT_EQ(Decode(builder), Status::kOk);
  ASSERT_EQ(packet_->points.size(), 4U);
  EXPECT_EQ(packet_->points[1].dt_ns, packet_->points[2].dt_ns);
  EXPECT_EQ(packet_->points[3].dt_ns, 3 * 50'000 + 3 * 1'512);
}

TEST_F(HesaiXt32Test, UnwrapsTheHour) {
  HesaiBuilder before;
  before.Rotate(0, 18).Date(10, 59, 59).Microseconds(999'900);
  ASSERT_EQ(Decode(before), Status::kOk);
  const TimeNs last = packet_->t;
  HesaiBuilder after;
  after.Rotate(0, 18).Date(11, 0, 0).Microseconds(300);
  ASSERT_EQ(Decode(after), Status::kOk);
  EXPECT_EQ((packet_->t - last).ns, 400'000);
}

TEST_F(HesaiXt32Test, RefusesTimesThatDoNotExist) {
  for (const auto& [minute, second, us] : {std::tuple{60, 0, 0U}, {0, 60, 0U}, {0, 0, 1'000'000U}, {255, 255, ~0U}}) {
    HesaiBuilder builder;
    builder.Rotate(0, 18)
        .Date(0, static_cast<std::uint8_t>(minute), static_cast<std::uint8_t>(second))
        .Microseconds(us);
    EXPECT_EQ(Decode(builder), Status::kBadInput);
  }
  EXPECT_EQ(codec_.counters().wrong_time, 4U);
}

TEST_F(HesaiXt32Test, CountsWhatTheSensorsNumbersMiss) {
  for (const std::uint32_t number : {0xFFFFFFFEU, 0xFFFFFFFFU, 0U, 3U, 2U, 4U, 4U, 10U}) {
    HesaiBuilder builder;
    builder.Rotate(0, 18).Number(number);
    ASSERT_EQ(Decode(builder), Status::kOk);
  }
  EXPECT_EQ(codec_.counters().lost, 2U + 5U) << "1 and 2 before 3, of which 2 only came late; 5 to 9";
}

TEST_F(HesaiXt32Test, RefusesEveryOtherSize) {
  std::vector<std::uint8_t> big(65507);
  HesaiBuilder builder;
  builder.Rotate(0, 18).Everywhere(1000);
  std::copy(builder.bytes().begin(), builder.bytes().end(), big.begin());
  for (std::size_t size = 0; size < 2500; ++size) {
    if (size == HesaiXt32::kPayloadBytes) continue;
    ASSERT_EQ(codec_.Decode(std::span(big).first(size), {}, packet_.get()), Status::kBadInput);
  }
  EXPECT_EQ(codec_.counters().wrong_size, 2499U);
}

TEST_F(HesaiXt32Test, RefusesAPacketWithAnyWrongIdentification) {
  for (const std::size_t at : {0U, 1U, 2U, 6U, 7U, 9U, unsigned{HesaiXt32::kFactoryAt}, unsigned{HesaiXt32::kModeAt}}) {
    int accepted = 0;
    for (int value = 0; value < 256; ++value) {
      HesaiBuilder builder;
      builder.Rotate(0, 18).Everywhere(1000);
      builder.bytes()[at] = static_cast<std::uint8_t>(value);
      accepted += Decode(builder) == Status::kOk ? 1 : 0;
    }
    EXPECT_EQ(accepted, at == HesaiXt32::kModeAt ? 6 : 1) << at;
  }
}

TEST_F(HesaiXt32Test, RefusesEveryAzimuthBeyondTheTurn) {
  for (int azimuth = 0; azimuth <= 0xFFFF; ++azimuth) {
    HesaiBuilder builder;
    builder.Rotate(0, 18).Azimuth(static_cast<std::size_t>(azimuth) % 8, static_cast<std::uint16_t>(azimuth));
    ASSERT_EQ(Decode(builder) == Status::kOk, azimuth < 36000) << azimuth;
  }
}

}  // namespace
}  // namespace mapweld::lidar
