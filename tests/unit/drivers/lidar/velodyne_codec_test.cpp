// SPDX-License-Identifier: Apache-2.0
#include "drivers/lidar/velodyne_codec.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "tests/unit/drivers/lidar/velodyne_packet.hpp"

namespace mapweld::lidar {
namespace {

using test::PacketBuilder;

constexpr double kDeg = std::numbers::pi / 180.0;

double AzimuthRad(const sensor::LidarPoint& point) {
  return std::atan2(-double{point.y}, double{point.x});
}

class Vlp16 : public testing::Test {
 protected:
  Status Decode(PacketBuilder& builder) { return codec_.Decode(builder.bytes(), {}, packet_.get()); }

  VelodyneCodec codec_{kVlp16};
  std::unique_ptr<sensor::LidarPacket> packet_ = std::make_unique<sensor::LidarPacket>();
};

TEST_F(Vlp16, PutsEachLaserWhereTheManualSays) {
  for (std::size_t laser = 0; laser < 16; ++laser) {
    PacketBuilder builder;
    // 90 degrees is to the right of the sensor. No rotation, so that the azimuth is the same for all lasers.
    builder.Rotate(9000, 0).Return(0, 0, laser, 5000, 77);
    ASSERT_EQ(Decode(builder), Status::kOk);
    ASSERT_EQ(packet_->points.size(), 1U);
    const sensor::LidarPoint& point = packet_->points[0];
    const double elevation = (laser % 2 == 0 ? -15.0 + static_cast<double>(laser) : static_cast<double>(laser)) * kDeg;
    EXPECT_NEAR(point.x, 0.0, 1e-5);
    EXPECT_NEAR(point.y, -10.0 * std::cos(elevation), 1e-5);
    EXPECT_NEAR(point.z, 10.0 * std::sin(elevation), 1e-5);
    EXPECT_EQ(point.intensity, 77.0F);
    EXPECT_EQ(point.ring, laser % 2 == 0 ? laser / 2 : 8 + laser / 2);
  }
}

TEST_F(Vlp16, LooksForwardAtAzimuthZeroAndLeftAt270Degrees) {
  PacketBuilder ahead;
  ahead.Rotate(0, 0).Return(0, 0, 1, 1000);
  ASSERT_EQ(Decode(ahead), Status::kOk);
  EXPECT_NEAR(packet_->points[0].x, 2.0 * std::cos(kDeg), 1e-5);
  EXPECT_NEAR(packet_->points[0].y, 0.0, 1e-6);
  PacketBuilder left;
  left.Rotate(27000, 0).Return(0, 0, 1, 1000);
  ASSERT_EQ(Decode(left), Status::kOk);
  EXPECT_NEAR(packet_->points[0].x, 0.0, 1e-5);
  EXPECT_NEAR(packet_->points[0].y, 2.0 * std::cos(kDeg), 1e-5);
}

TEST_F(Vlp16, OrdersRingsByElevation) {
  PacketBuilder builder;
  builder.Rotate(0, 0);
  for (std::size_t laser = 0; laser < 16; ++laser) builder.Return(0, 0, laser, 5000);
  ASSERT_EQ(Decode(builder), Status::kOk);
  std::vector<float> height(16);
  for (const sensor::LidarPoint& point : packet_->points) height[point.ring] = point.z;
  for (std::size_t ring = 1; ring < 16; ++ring) EXPECT_LT(height[ring - 1], height[ring]);
}

TEST_F(Vlp16, GivesEveryLaserItsFiringTimeAndAzimuth) {
  PacketBuilder builder;
  builder.Rotate(35990, 40).Everywhere(5000);
  ASSERT_EQ(Decode(builder), Status::kOk);
  ASSERT_EQ(packet_->points.size(), 384U);
  for (std::size_t i = 0; i < packet_->points.size(); ++i) {
    const sensor::LidarPoint& point = packet_->points[i];
    const double dt_us = static_cast<double>(i / 16) * 55.296 + static_cast<double>(i % 16) * 2.304;
    EXPECT_NEAR(point.dt_ns, dt_us * 1000, 0.51);
    const double expected_deg = std::fmod(359.90 + 0.40 * dt_us / 110.592, 360.0);
    const double azimuth_deg = std::fmod(AzimuthRad(point) / kDeg + 360.0, 360.0);
    EXPECT_NEAR(azimuth_deg, expected_deg, 1e-4) << i;
  }
  EXPECT_EQ(packet_->azimuth_first_cdeg, 35990);
  EXPECT_EQ(packet_->azimuth_last_cdeg, (35990 + 11 * 40) % 36000);
}

TEST_F(Vlp16, ReadsBothReturnsOfADualPacketOnce) {
  PacketBuilder builder(VelodynePacket::kDual);
  builder.Rotate(100, 40);
  builder.Return(2, 1, 5, 5000, 10).Return(3, 1, 5, 5000, 10);  // the same return twice
  builder.Return(4, 0, 3, 5000, 10).Return(5, 0, 3, 6000, 20);  // two returns
  builder.Return(7, 0, 3, 6000, 20);                            // only a second one
  ASSERT_EQ(Decode(builder), Status::kOk);
  ASSERT_EQ(packet_->points.size(), 4U);
  EXPECT_NEAR(packet_->points[0].dt_ns, (1 * 110.592 + 55.296 + 5 * 2.304) * 1000, 0.51);
  EXPECT_EQ(packet_->points[1].dt_ns, packet_->points[2].dt_ns);
  EXPECT_NEAR(packet_->points[3].dt_ns, (3 * 110.592 + 3 * 2.304) * 1000, 0.51);
  const double azimuth = (1.00 + 2 * 0.40 + 0.40 * 3 * 2.304 / 110.592) * kDeg;
  EXPECT_NEAR(AzimuthRad(packet_->points[2]), azimuth, 1e-6);
}

TEST_F(Vlp16, SkipsMissingReturns) {
  PacketBuilder builder;
  builder.Rotate(0, 40);
  ASSERT_EQ(Decode(builder), Status::kOk);
  EXPECT_TRUE(packet_->points.empty());
  EXPECT_EQ(codec_.counters().packets, 1U);
}

TEST_F(Vlp16, UnwrapsTheHour) {
  PacketBuilder builder;
  builder.Rotate(0, 40);
  ASSERT_EQ(Decode(builder.Time(3'599'999'900)), Status::kOk);
  const TimeNs before = packet_->t;
  ASSERT_EQ(Decode(builder.Time(1'227)), Status::kOk);
  EXPECT_EQ((packet_->t - before).ns, 1'327'000);
  EXPECT_EQ(Decode(builder.Time(3'600'000'000)), Status::kOutOfRange);
  EXPECT_EQ(codec_.counters().wrong_time, 1U);
}

TEST_F(Vlp16, RefusesEveryOtherSize) {
  std::vector<std::uint8_t> big(65507);
  PacketBuilder builder;
  builder.Rotate(0, 40).Everywhere(1000);
  std::copy(builder.bytes().begin(), builder.bytes().end(), big.begin());
  std::uint64_t refused = 0;
  for (std::size_t size = 0; size < 2500; ++size) {
    if (size == VelodynePacket::kPayloadBytes) continue;
    ASSERT_EQ(codec_.Decode(std::span(big).first(size), {}, packet_.get()), Status::kBadInput);
    ASSERT_TRUE(packet_->points.empty());
    ++refused;
  }
  ASSERT_EQ(codec_.Decode(big, {}, packet_.get()), Status::kBadInput);
  EXPECT_EQ(codec_.counters().wrong_size, refused + 1);
}

TEST_F(Vlp16, RefusesOtherSensorsAndModes) {
  for (int value = 0; value < 256; ++value) {
    PacketBuilder builder;
    builder.Rotate(0, 40).Everywhere(1000);
    builder.bytes()[VelodynePacket::kModelAt] = static_cast<std::uint8_t>(value);
    ASSERT_EQ(Decode(builder) == Status::kOk, value == 0x22) << value;
  }
  EXPECT_EQ(codec_.counters().wrong_model, 255U);
  for (int value = 0; value < 256; ++value) {
    PacketBuilder builder(static_cast<std::uint8_t>(value));
    builder.Rotate(0, 40).Everywhere(1000);
    ASSERT_EQ(Decode(builder) == Status::kOk, value >= 0x37 && value <= 0x39) << value;
  }
  EXPECT_EQ(codec_.counters().wrong_mode, 253U);
}

TEST_F(Vlp16, RefusesAPacketWithOneWrongBlock) {
  for (std::size_t block = 0; block < VelodynePacket::kBlocks; ++block) {
    for (const std::size_t byte : {0U, 1U}) {
      PacketBuilder builder;
      builder.Rotate(0, 40).Everywhere(1000);
      builder.bytes()[block * VelodynePacket::kBlockBytes + byte] ^= 0x10;
      ASSERT_EQ(Decode(builder), Status::kBadInput);
      ASSERT_TRUE(packet_->points.empty()) << "no point comes from a bad packet";
    }
  }
  EXPECT_EQ(codec_.counters().wrong_flag, 2 * VelodynePacket::kBlocks);
}

TEST_F(Vlp16, RefusesEveryAzimuthBeyondTheTurn) {
  std::uint64_t refused = 0;
  for (int azimuth = 0; azimuth <= 0xFFFF; ++azimuth) {
    const std::size_t block = static_cast<std::size_t>(azimuth) % VelodynePacket::kBlocks;
    PacketBuilder builder;
    builder.Rotate(0, 40).Azimuth(block, static_cast<std::uint16_t>(azimuth)).Return(block, 1, 15, 1000);
    const bool good = azimuth < 36000;
    ASSERT_EQ(Decode(builder) == Status::kOk, good) << azimuth;
    refused += good ? 0 : 1;
    if (good) {
      const sensor::LidarPoint& point = packet_->points[0];
      ASSERT_NEAR(std::hypot(point.x, point.y, point.z), 2.0, 1e-5);
    }
  }
  EXPECT_EQ(codec_.counters().wrong_azimuth, refused);
}

TEST_F(Vlp16, InterpolatesOverAnOddStepWithTheStepBefore) {
  PacketBuilder builder;
  builder.Rotate(1000, 40).Azimuth(6, 30000).Everywhere(5000);
  ASSERT_EQ(Decode(builder), Status::kOk);
  EXPECT_EQ(codec_.counters().odd_steps, 2U) << "the step to the odd block and the one from it";
  // Second firing of block 5: its own azimuth and half the usual step.
  const sensor::LidarPoint& point = packet_->points[5 * 32 + 16];
  EXPECT_NEAR(AzimuthRad(point) / kDeg, 10.0 + 5 * 0.4 + 0.2, 1e-4);
}

TEST_F(Vlp16, DecodesASensorThatStandsStill) {
  PacketBuilder builder;
  builder.Rotate(1234, 0).Everywhere(5000);
  ASSERT_EQ(Decode(builder), Status::kOk);
  EXPECT_EQ(packet_->points.size(), 384U);
  EXPECT_EQ(codec_.counters().odd_steps, 0U);
}

TEST_F(Vlp16, KeepsItsAnglesFrom300To1200RevolutionsPerMinute) {
  for (const int rpm : {300, 600, 900, 1200}) {
    const double step_cdeg = rpm * 6.0 * 100 * 110.592e-6;  // per block
    PacketBuilder builder;
    for (std::size_t block = 0; block < VelodynePacket::kBlocks; ++block) {
      builder.Azimuth(
          block, static_cast<std::uint16_t>(std::lround(35'950 + static_cast<double>(block) * step_cdeg) % 36'000));
    }
    builder.Everywhere(5000);
    ASSERT_EQ(Decode(builder), Status::kOk);
    EXPECT_EQ(codec_.counters().odd_steps, 0U) << rpm;
    for (const sensor::LidarPoint& point : packet_->points) {
      const double expected_rad = (359.50 + rpm * 6.0 * point.dt_ns * 1e-9) * kDeg;
      // Azimuths are rounded to 0.01 degrees in the packet.
      EXPECT_NEAR(std::remainder(AzimuthRad(point) - expected_rad, 2 * std::numbers::pi), 0.0, 0.011 * kDeg) << rpm;
    }
  }
}

TEST_F(Vlp16, RefusesTheOtherModels) {
  for (const VelodyneModel& other : {kHdl32e, kVlp32c}) {
    PacketBuilder builder(VelodynePacket::kStrongest, other);
    builder.Rotate(0, 20).Everywhere(1000);
    EXPECT_EQ(Decode(builder), Status::kBadInput);
  }
  EXPECT_EQ(codec_.counters().wrong_model, 2U);
}

class ThirtyTwoLasers : public testing::TestWithParam<const VelodyneModel*> {};

TEST_P(ThirtyTwoLasers, GoWhereAndWhenTheManualSays) {
  const VelodyneModel& model = *GetParam();
  VelodyneCodec codec(model);
  auto packet = std::make_unique<sensor::LidarPacket>();
  PacketBuilder builder(VelodynePacket::kLast, model);
  builder.Rotate(9000, 20).Everywhere(2500);
  ASSERT_EQ(codec.Decode(builder.bytes(), {}, packet.get()), Status::kOk);
  ASSERT_EQ(packet->points.size(), 384U);
  for (std::size_t i = 0; i < packet->points.size(); ++i) {
    const sensor::LidarPoint& point = packet->points[i];
    const std::size_t laser = i % 32;
    const double in_block_ns =
        static_cast<double>(laser / model.lasers_at_once) * static_cast<double>(model.laser_period_ps) / 1e3;
    const double block_ns = static_cast<double>(model.firing_period_ps) / 1e3;
    EXPECT_NEAR(point.dt_ns, static_cast<double>(i / 32) * block_ns + in_block_ns, 0.51);
    const double range_m = static_cast<double>(2500 + i / 32) * model.distance_unit_m;
    EXPECT_NEAR(std::hypot(point.x, point.y, point.z), range_m, 1e-5);
    EXPECT_NEAR(std::asin(double{point.z} / range_m) / kDeg, model.elevation_deg[laser], 1e-3);
    const double azimuth_deg =
        90.0 + static_cast<double>(i / 32) * 0.2 + 0.2 * in_block_ns / block_ns + model.azimuth_deg[laser];
    EXPECT_NEAR(AzimuthRad(point) / kDeg, azimuth_deg, 1e-4);
  }
}

TEST_P(ThirtyTwoLasers, NumberRingsFromTheLowest) {
  const VelodyneModel& model = *GetParam();
  const VelodyneCodec codec(model);
  std::vector<double> elevation_of_ring(32, -100);
  for (std::size_t laser = 0; laser < 32; ++laser) elevation_of_ring[codec.ring(laser)] = model.elevation_deg[laser];
  EXPECT_TRUE(std::ranges::is_sorted(elevation_of_ring));
  EXPECT_GT(elevation_of_ring[0], -100) << "every ring is taken";
}

TEST_P(ThirtyTwoLasers, GiveBothReturnsOfADualPacketOnce) {
  const VelodyneModel& model = *GetParam();
  VelodyneCodec codec(model);
  auto packet = std::make_unique<sensor::LidarPacket>();
  PacketBuilder builder(VelodynePacket::kDual, model);
  builder.Rotate(100, 20);
  builder.Return(2, 0, 31, 5000).Return(3, 0, 31, 5000);  // the same return twice
  builder.Return(4, 0, 7, 5000).Return(5, 0, 7, 6000);    // two returns
  ASSERT_EQ(codec.Decode(builder.bytes(), {}, packet.get()), Status::kOk);
  ASSERT_EQ(packet->points.size(), 3U);
  EXPECT_EQ(packet->points[1].dt_ns, packet->points[2].dt_ns);
  EXPECT_LT(packet->points[0].dt_ns, packet->points[1].dt_ns);
}

INSTANTIATE_TEST_SUITE_P(Models, ThirtyTwoLasers, testing::Values(&kHdl32e, &kVlp32c),
                         [](const auto& model) { return model.param == &kHdl32e ? "Hdl32e" : "Vlp32c"; });

}  // namespace
}  // namespace mapweld::lidar
