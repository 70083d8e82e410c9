// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/scan/deskew.hpp"
#include "core/scan/scan_accumulator.hpp"
#include "core/scan/voxel_downsample.hpp"

namespace mapweld::scan {
namespace {

// One packet of a 10 Hz sensor: 4.8 degrees in 1.33 ms.
sensor::LidarPacket Packet(int i) {
  sensor::LidarPacket packet;
  packet.t = {i * 1'333'333LL};
  packet.azimuth_first_cdeg = static_cast<std::uint16_t>((i * 480) % 36000);
  packet.azimuth_last_cdeg = static_cast<std::uint16_t>((i * 480 + 440) % 36000);
  for (int k = 0; k < 4; ++k) {
    (void)packet.points.TryPush({static_cast<float>(i), 0, 0, 10, k * 300'000, static_cast<std::uint16_t>(k), 0});
  }
  return packet;
}

class ScanAccumulatorTest : public testing::Test {
 protected:
  std::unique_ptr<ScanAccumulator> accumulator_ = std::make_unique<ScanAccumulator>();
  std::unique_ptr<sensor::Scan> scan_ = std::make_unique<sensor::Scan>();
  bool has_scan_ = false;
};

TEST_F(ScanAccumulatorTest, ARevolutionHoldsEveryPacketOnce) {
  int scans = 0;
  for (int i = 0; i < 75 * 3 + 1; ++i) {
    ASSERT_EQ(accumulator_->Add(Packet(i), scan_.get(), &has_scan_), Status::kOk);
    if (!has_scan_) continue;
    ++scans;
    EXPECT_EQ(scan_->points.size(), 75U * 4);
    EXPECT_NEAR((scan_->t_end - scan_->t_begin).Seconds(), 0.1, 0.002);
  }
  EXPECT_EQ(scans, 3);
}

TEST_F(ScanAccumulatorTest, PointTimesCountFromTheBeginningOfTheScan) {
  for (int i = 0; i <= 75; ++i) ASSERT_EQ(accumulator_->Add(Packet(i), scan_.get(), &has_scan_), Status::kOk);
  ASSERT_TRUE(has_scan_);
  EXPECT_EQ(scan_->points[0].dt_ns, 0);
  EXPECT_EQ(scan_->points[4].dt_ns, 1'333'333);
  EXPECT_EQ(scan_->points[5].dt_ns, 1'633'333);
}

TEST_F(ScanAccumulatorTest, LostPacketsOnlyLeaveAGap) {
  int scans = 0;
  for (int i = 0; i < 75 * 4; ++i) {
    if (i % 75 > 70 || i % 75 < 3) continue;  // around the zero, where it hurts most
    ASSERT_EQ(accumulator_->Add(Packet(i), scan_.get(), &has_scan_), Status::kOk);
    scans += has_scan_ ? 1 : 0;
  }
  EXPECT_EQ(scans, 3);
}

TEST_F(ScanAccumulatorTest, RepeatedAndLatePacketsAreDroppedAndCounted) {
  ASSERT_EQ(accumulator_->Add(Packet(0), scan_.get(), &has_scan_), Status::kOk);
  ASSERT_EQ(accumulator_->Add(Packet(1), scan_.get(), &has_scan_), Status::kOk);
  EXPECT_EQ(accumulator_->Add(Packet(1), scan_.get(), &has_scan_), Status::kStale);
  EXPECT_EQ(accumulator_->Add(Packet(0), scan_.get(), &has_scan_), Status::kStale);
  EXPECT_EQ(accumulator_->stale_packets(), 2U);
  ASSERT_TRUE(accumulator_->Flush(scan_.get()));
  EXPECT_EQ(scan_->points.size(), 8U);
}

TEST_F(ScanAccumulatorTest, ASensorThatDoesNotTurnStillGivesScans) {
  int scans = 0;
  for (int i = 0; i < 750; ++i) {
    sensor::LidarPacket packet = Packet(i);
    packet.azimuth_first_cdeg = packet.azimuth_last_cdeg = 9000;
    ASSERT_EQ(accumulator_->Add(packet, scan_.get(), &has_scan_), Status::kOk);
    scans += has_scan_ ? 1 : 0;
  }
  EXPECT_EQ(scans, 3);
}

TEST(Deskew, AWallSeenFromAMovingVehicleComesOutStraight) {
  // The body moves 1 m along x and turns 0.2 rad during the scan; every point is the same corner of the world.
  auto scan = std::make_unique<sensor::Scan>();
  scan->t_begin = {0};
  scan->t_end = {100'000'000};
  ScanMotion motion;
  const geom::Vec3d corner_end(20, 5, 1);  // in the body frame at the end of the scan
  const auto end_T_body = [](double s) { return geom::Pose3{{-(1 - s), 0, 0}, geom::ExpSo3({0, 0, -0.2 * (1 - s)})}; };
  for (std::size_t i = 0; i <= ScanMotion::kSteps; ++i) {
    motion.end_T_body[i] = end_T_body(static_cast<double>(i) / ScanMotion::kSteps);
  }
  const geom::Pose3 body_T_lidar{{0.1, 0, 0.3}, geom::ExpSo3({0, 0, 0.5})};
  for (int i = 0; i <= 1000; ++i) {
    const double s = i / 1000.0;
    const Eigen::Vector3f p = ((end_T_body(s) * body_T_lidar).Inverse() * corner_end).cast<float>();
    ASSERT_EQ(scan->points.TryPush({p.x(), p.y(), p.z(), 0, static_cast<std::int32_t>(s * 1e8), 0, 0}), Status::kOk);
  }
  auto out = std::make_unique<BodyPoints>();
  Deskew(*scan, motion, body_T_lidar, {}, out.get());
  ASSERT_EQ(out->size(), 1001U);
  for (const BodyPoint& point : *out) EXPECT_LT((point.p - corner_end.cast<float>()).norm(), 1e-3F);
}

TEST(Deskew, DropsPointsOutOfRangeAndNan) {
  auto scan = std::make_unique<sensor::Scan>();
  scan->t_end = {100};
  for (float x : {0.1F, 10.0F, 500.0F, NAN}) ASSERT_EQ(scan->points.TryPush({x, 0, 0, 0, 0, 0, 0}), Status::kOk);
  auto out = std::make_unique<BodyPoints>();
  Deskew(*scan, {}, {}, {}, out.get());
  ASSERT_EQ(out->size(), 1U);
  EXPECT_EQ((*out)[0].p.x(), 10.0F);
}

TEST(VoxelDownsample, KeepsTheFirstPointOfEachVoxel) {
  auto in = std::make_unique<BodyPoints>();
  for (float x : {0.1F, 0.2F, 0.9F, 1.1F, 0.3F, -0.1F}) ASSERT_EQ(in->TryPush({{x, 0.5F, 0.5F}}), Status::kOk);
  auto out = std::make_unique<FeaturePoints>();
  auto downsample = std::make_unique<VoxelDownsample>();
  for (int run = 0; run < 3; ++run) {  // the table is reused
    downsample->Run(*in, 1.0F, out.get());
    ASSERT_EQ(out->size(), 3U);
    EXPECT_EQ((*out)[0].p.x(), 0.1F);
    EXPECT_EQ((*out)[1].p.x(), 1.1F);
    EXPECT_EQ((*out)[2].p.x(), -0.1F);
  }
}

}  // namespace
}  // namespace mapweld::scan
