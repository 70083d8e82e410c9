// SPDX-License-Identifier: Apache-2.0
#include "drivers/lidar/ouster_codec.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "tests/unit/drivers/lidar/ouster_packet.hpp"

namespace mapweld::lidar {
namespace {

using test::OusterBuilder;

constexpr double kDeg = std::numbers::pi / 180.0;

struct ProfileCase {
  OusterProfile profile;
  const char* name;
  std::uint64_t pixel;  // 8 m, reflectivity 77
  std::size_t bytes_of_64_beams;
};

class OusterProfiles : public testing::TestWithParam<ProfileCase> {
 protected:
  void SetUp() override {
    OusterMetadata metadata;
    ASSERT_EQ(ParseOusterMetadata(test::OusterJson(64, GetParam().name), &metadata), Status::kOk);
    ASSERT_EQ(metadata.profile, GetParam().profile);
    codec_.Configure(metadata);
    metadata_ = metadata;
  }
  Status Decode(OusterBuilder& builder) { return codec_.Decode(builder.bytes(), {}, packet_.get()); }

  OusterBuilder builder_{GetParam().profile, 64};
  OusterMetadata metadata_;
  OusterCodec codec_;
  std::unique_ptr<sensor::LidarPacket> packet_ = std::make_unique<sensor::LidarPacket>();
};

TEST_P(OusterProfiles, HaveTheSizeOfTheManual) {
  EXPECT_EQ(builder_.bytes().size(), GetParam().bytes_of_64_beams);
}

TEST_P(OusterProfiles, PutEachBeamWhereTheMetadataSays) {
  for (std::size_t beam = 0; beam < 64; ++beam) {
    OusterBuilder builder(GetParam().profile, 64);
    builder.Column(3, 1'000'000'000 + 3 * 97'656, 256).Pixel(3, beam, GetParam().pixel);
    ASSERT_EQ(Decode(builder), Status::kOk);
    ASSERT_EQ(packet_->points.size(), 1U);
    const sensor::LidarPoint& point = packet_->points[0];
    // Column 0 looks back towards the connector; a quarter of a turn later the beam leaves to our left, along +y.
    const double n = 0.015806;
    const double elevation = metadata_.beams.elevation_deg[beam] * kDeg;
    const double azimuth = (180.0 + 90.0 + metadata_.beams.azimuth_deg[beam]) * kDeg;  // clockwise from our x
    const double level = (8.0 - n) * std::cos(elevation);
    EXPECT_NEAR(point.x, level * std::cos(azimuth) + n * std::cos(270 * kDeg), 1e-5);
    EXPECT_NEAR(point.y, -level * std::sin(azimuth) - n * std::sin(270 * kDeg), 1e-5);
    EXPECT_NEAR(point.z, (8.0 - n) * std::sin(elevation), 1e-5);
    EXPECT_EQ(point.intensity, 77.0F);
    EXPECT_EQ(point.ring, 63 - beam);
    EXPECT_EQ(point.dt_ns, 3 * 97'656);
  }
}

TEST_P(OusterProfiles, LeaveInvalidColumnsOut) {
  for (std::size_t i = 0; i < 16; ++i) builder_.Pixel(i, 10, GetParam().pixel).Valid(i, i % 4 == 3);
  ASSERT_EQ(Decode(builder_), Status::kOk);
  ASSERT_EQ(packet_->points.size(), 4U);
  EXPECT_EQ(packet_->t.ns, 1'000'000'000 + 3 * 97'656 - 3 * 97'656 % 1000) << "of the first valid column";
  EXPECT_EQ(packet_->azimuth_first_cdeg, 3 * 36000 / 1024);
  EXPECT_EQ(packet_->azimuth_last_cdeg, 15 * 36000 / 1024);
  for (std::size_t i = 0; i < 16; ++i) builder_.Valid(i, false);
  EXPECT_EQ(Decode(builder_), Status::kEmpty);
  EXPECT_EQ(codec_.counters().empty, 1U);
}

TEST_P(OusterProfiles, AreRefusedInAnyOtherSize) {
  auto& bytes = builder_.bytes();
  bytes.push_back(0);
  EXPECT_EQ(Decode(builder_), Status::kBadInput);
  bytes.resize(bytes.size() - 2);
  EXPECT_EQ(Decode(builder_), Status::kBadInput);
  bytes.clear();
  EXPECT_EQ(Decode(builder_), Status::kBadInput);
  EXPECT_EQ(codec_.counters().wrong_size, 3U);
}

TEST_P(OusterProfiles, RefuseColumnsThatAreNotOneSweep) {
  builder_.Column(5, 1'000'000'000 + 5 * 97'656, 1024).Pixel(1, 1, GetParam().pixel);
  EXPECT_EQ(Decode(builder_), Status::kBadInput);
  EXPECT_EQ(codec_.counters().wrong_azimuth, 1U);
  for (const std::uint64_t t_ns : {999'999'999ULL, 1'060'000'000ULL, 0ULL, ~0ULL}) {
    builder_.Column(5, t_ns, 5);
    EXPECT_EQ(Decode(builder_), Status::kBadInput);
    EXPECT_TRUE(packet_->points.empty());
  }
  EXPECT_EQ(codec_.counters().wrong_time, 4U);
}

INSTANTIATE_TEST_SUITE_P(
    Ouster, OusterProfiles,
    testing::Values(ProfileCase{OusterProfile::kLegacy, "LEGACY", 8000ULL | 77ULL << 32U, 12'608},
                    ProfileCase{OusterProfile::kSingle, "RNG19_RFL8_SIG16_NIR16", 8000ULL | 77ULL << 32U, 12'544},
                    ProfileCase{OusterProfile::kLowRate, "RNG15_RFL8_NIR8", 1000ULL | 77ULL << 16U, 4'352},
                    ProfileCase{OusterProfile::kDual, "RNG19_RFL8_SIG16_NIR16_DUAL",
                                8000ULL | 77ULL << 24U | 8000ULL << 32U, 16'640}),
    [](const auto& one) { return one.param.name; });

TEST(Ouster, GivesTwoReturnsThatDiffer) {
  OusterMetadata metadata;
  ASSERT_EQ(ParseOusterMetadata(test::OusterJson(128, "RNG19_RFL8_SIG16_NIR16_DUAL"), &metadata), Status::kOk);
  OusterCodec codec;
  codec.Configure(metadata);
  auto packet = std::make_unique<sensor::LidarPacket>();
  OusterBuilder builder(OusterProfile::kDual, 128);
  for (std::size_t i = 0; i < 16 * 128; ++i) builder.Pixel(i / 128, i % 128, 8000ULL | 9000ULL << 32U);
  ASSERT_EQ(codec.Decode(builder.bytes(), {}, packet.get()), Status::kOk);
  EXPECT_EQ(packet->points.size(), 2U * 16 * 128) << "the largest packet there is fits";
}

TEST(Ouster, RefusesEverythingWithoutMetadata) {
  OusterCodec codec;
  auto packet = std::make_unique<sensor::LidarPacket>();
  OusterBuilder builder(OusterProfile::kLegacy, 64);
  EXPECT_EQ(codec.Decode(builder.bytes(), {}, packet.get()), Status::kBadInput);
  EXPECT_EQ(codec.Decode({}, {}, packet.get()), Status::kBadInput);
}

}  // namespace
}  // namespace mapweld::lidar
