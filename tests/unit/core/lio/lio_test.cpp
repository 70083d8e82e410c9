// SPDX-License-Identifier: Apache-2.0
#include "core/lio/lio.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/scan/scan_accumulator.hpp"
#include "tests/support/street_drive.hpp"

namespace mapweld::lio {
namespace {

// Drives a street; gives the last update and remembers the worst position error.
class LioDrive {
 public:
  explicit LioDrive(const test::StreetDriveConfig& config) : street_(std::make_unique<test::StreetDrive>(config)) {}

  void Run() {
    sensor::LidarPacket packet;
    FixedVector<sensor::ImuSample, 16> samples;
    bool has_scan = false;
    bool waits = false;
    while (street_->Next(&packet, &samples)) {
      for (const auto& sample : samples) EXPECT_EQ(lio_->AddImu(sample), Status::kOk);
      if (waits) {
        waits = false;
        if (lio_->AddScan(*scan_, &update_) == Status::kOk) Record();
      }
      EXPECT_EQ(accumulator_->Add(packet, scan_.get(), &has_scan), Status::kOk);
      waits = has_scan;
    }
  }

  void Record() {
    const geom::Pose3 truth = street_->TruthAt(update_.t);
    error_m_ = (update_.odom_T_body.t - truth.t).norm();
    worst_m_ = std::max(worst_m_, error_m_);
    error_rad_ = update_.odom_T_body.q.angularDistance(truth.q);
    const double t_s = static_cast<double>(update_.t.ns) * 1e-9;
    if (t_s > 12.2 && t_s < 13) sigma_in_gap_m_ += update_.sigma_m;
    if (street_->PathAt(update_.t) < 10) return;  // 16 beams at rest draw lines, not planes
    degenerate_ += update_.degenerate ? 1 : 0;
    ++scans_;
  }

  std::unique_ptr<test::StreetDrive> street_;
  std::unique_ptr<Lio> lio_ = std::make_unique<Lio>();
  std::unique_ptr<scan::ScanAccumulator> accumulator_ = std::make_unique<scan::ScanAccumulator>();
  std::unique_ptr<sensor::Scan> scan_ = std::make_unique<sensor::Scan>();
  LioUpdate update_;
  double error_m_ = 0;
  double worst_m_ = 0;
  double error_rad_ = 0;
  double sigma_in_gap_m_ = 0;  // sum over the scans of that interval
  int degenerate_ = 0;
  int scans_ = 0;
};

TEST(Lio, FollowsAStreetToHalfAPercent) {
  LioDrive drive({});
  drive.Run();
  const double path = drive.street_->PathAt(drive.update_.t);
  ASSERT_GT(path, 150);
  EXPECT_LT(drive.error_m_, 0.005 * path);
  EXPECT_LT(drive.error_rad_, 0.01);
  EXPECT_LT(drive.degenerate_, drive.scans_ / 50);
}

TEST(Lio, StandsStillAtRest) {
  LioDrive drive({.seconds = 10, .rest_s = 100});
  drive.Run();
  ASSERT_GT(drive.update_.t.ns, 9'000'000'000);
  EXPECT_LT(drive.worst_m_, 0.05);
}

TEST(Lio, SurvivesASecondWithoutImuAndSaysSo) {
  LioDrive clean({.seconds = 20});
  clean.Run();
  LioDrive gap({.seconds = 20, .imu_gap_from_s = 12, .imu_gap_to_s = 13});
  gap.Run();
  EXPECT_LT(gap.error_m_, 1.5 * clean.error_m_ + 0.3);
  EXPECT_GT(gap.sigma_in_gap_m_, 1.2 * clean.sigma_in_gap_m_);
}

TEST(Lio, FlagsACorridorThatDoesNotFixThePosition) {
  LioDrive drive({.seconds = 15, .weave_m = 0, .corridor = true});
  drive.Run();
  EXPECT_GT(drive.degenerate_, drive.scans_ * 9 / 10);
  EXPECT_LT(std::abs(drive.update_.odom_T_body.t.y()), 0.2);  // across the corridor all is well
}

TEST(Lio, RefusesBrokenSamplesAndScansAndGoesOn) {
  auto lio = std::make_unique<Lio>();
  const auto imu = [&](std::int64_t ms, double gyro) {
    return lio->AddImu({{ms * 1'000'000}, {gyro, 0, 0}, {0, 0, 9.81}, false});
  };
  LioUpdate update;
  auto scan = std::make_unique<sensor::Scan>();
  EXPECT_EQ(lio->AddScan(*scan, &update), Status::kNotReady);
  for (std::int64_t ms = 0; ms <= 1100; ms += 5) EXPECT_EQ(imu(ms, 0), Status::kOk);
  ASSERT_TRUE(lio->aligned());
  EXPECT_EQ(imu(1200, NAN), Status::kBadInput);
  EXPECT_EQ(imu(500, 0), Status::kStale);
  EXPECT_EQ(imu(1105, 0), Status::kOk);
  EXPECT_EQ(lio->AddScan(*scan, &update), Status::kBadInput);  // empty
  ASSERT_EQ(scan->points.TryPush({5, 0, 0, 0, 0, 0, 0}), Status::kOk);
  scan->t_begin = {100'000'000};
  scan->t_end = {200'000'000};
  EXPECT_EQ(lio->AddScan(*scan, &update), Status::kStale);  // before the alignment
}

}  // namespace
}  // namespace mapweld::lio
