// SPDX-License-Identifier: Apache-2.0
// The agent's own decoder reads what the simulator writes: both follow the manual, neither knows the other.
#include "tools/sim/ouster_encoder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "drivers/lidar/ouster_codec.hpp"
#include "tests/unit/tools/sim/hall.hpp"

namespace mapweld::sim {
namespace {

constexpr std::int64_t kStart_ns = 601'000'000'000;

class OusterEncoder : public testing::Test {
 protected:
  OusterEncoder() {
    lidar::OusterMetadata metadata;
    EXPECT_EQ(lidar::ParseOusterMetadata(OusterMetadataJson(model_), &metadata), Status::kOk);
    EXPECT_EQ(metadata.columns_per_turn, 1024);
    codec_->Configure(metadata);
  }

  const RayCaster caster_{{std::make_shared<RayScene>(Hall())}};
  const VehicleMotion motion_{LanePath::Beside({{0, 0}, {60, 0}}), DrivingStyle{}, Relief(0, 1), 3};
  const LidarModel model_ = LidarByName("os1-64");
  const LidarSimulator lidar_{caster_, motion_, nullptr, model_, {}, kStart_ns, 77};
  std::unique_ptr<lidar::OusterCodec> codec_ = std::make_unique<lidar::OusterCodec>();
  std::unique_ptr<sensor::LidarPacket> packet_ = std::make_unique<sensor::LidarPacket>();
};

TEST_F(OusterEncoder, GivesTheAgentPointsThatLieOnTheWorld) {
  const std::int64_t first = 80 * 1024 / kOusterColumns;  // a whole turn after 8 s, at about 6 m/s
  std::int64_t sent = 0;
  std::size_t points = 0;
  double worst = 0;
  for (std::int64_t i = first; i < first + 1024 / kOusterColumns; ++i) {
    const auto bytes = EncodeOuster(lidar_, i, &sent);
    ASSERT_EQ(codec_->Decode(bytes, {lidar_.PastHour_ns(i * kOusterColumns)}, packet_.get()), Status::kOk);
    for (const sensor::LidarPoint& p : packet_->points) {
      const double t = static_cast<double>(lidar_.PastHour_ns(i * kOusterColumns) + p.dt_ns - kStart_ns) * 1e-9;
      worst = std::max(worst,
                       DistanceToHall(motion_.WorldFromBody(t) * (model_.body_T_lidar * geom::Vec3d(p.x, p.y, p.z))));
      ++points;
    }
  }
  EXPECT_EQ(points, static_cast<std::size_t>(sent));
  EXPECT_GT(points, 50'000U);
  EXPECT_LT(worst, 4.5 * (model_.range_sigma_m + 60 * model_.divergence_rad)) << "noise and beam width";
}

TEST_F(OusterEncoder, BeginsATurnBackwardAndKeepsItsColumnsInPlace) {
  std::int64_t returns = 0;
  const auto id = [&](std::int64_t packet) {
    const auto bytes = EncodeOuster(lidar_, packet, &returns);
    EXPECT_EQ(bytes.size(), 64U + 16 * (12 + 64 * 12));
    EXPECT_EQ(bytes[0], 1);
    return bytes[32 + 8] + 256 * bytes[32 + 9];
  };
  EXPECT_EQ(id(0), 512) << "forward at the whole tenth of a second";
  EXPECT_EQ(id(32), 0);
  EXPECT_EQ(id(1), 528);
  EXPECT_EQ(id(64 * 6000), 512) << "after ten minutes the same";
  const auto frame = [&](std::int64_t packet) { return EncodeOuster(lidar_, packet, &returns)[2]; };
  EXPECT_EQ(frame(0), 0);
  EXPECT_EQ(frame(31), 0);
  EXPECT_EQ(frame(32), 1) << "a frame begins with column 0";
  EXPECT_EQ(frame(95), 1);
  EXPECT_EQ(frame(96), 2);
}

}  // namespace
}  // namespace mapweld::sim
