// SPDX-License-Identifier: Apache-2.0
// The scans of a drive without motion distortion: the truth has taken it out, better than any odometry could. For
// comparisons with programs that know no IMU and no packets.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/geom/pose3.hpp"
#include "core/scan/deskew.hpp"
#include "core/scan/scan_accumulator.hpp"
#include "tools/io/tum.hpp"
#include "tools/odometry/sensor_sink.hpp"

namespace mapweld::odometry {

struct TrueScan {
  TimeNs t;                             // its end
  geom::Pose3 world_T_lidar;            // then
  std::vector<Eigen::Vector3f> points;  // m, in the LiDAR's frame at t
};

// Collects packets and hands out every scan that has truth at both ends. Other scans are left out.
class TrueScans final : public SensorSink {
 public:
  TrueScans(std::vector<io::StampedPose> world_T_body, const geom::Pose3& body_T_lidar,
            std::function<void(const TrueScan&)> take);

  void OnImu(const sensor::ImuSample&) override {}
  void OnPacket(const sensor::LidarPacket& packet) override;
  void Flush();

 private:
  void Undistort(const sensor::Scan& scan);

  std::vector<io::StampedPose> world_T_body_;
  geom::Pose3 body_T_lidar_;
  std::function<void(const TrueScan&)> take_;
  std::unique_ptr<scan::ScanAccumulator> accumulator_ = std::make_unique<scan::ScanAccumulator>();
  std::unique_ptr<sensor::Scan> scan_ = std::make_unique<sensor::Scan>();
  std::unique_ptr<scan::BodyPoints> points_ = std::make_unique<scan::BodyPoints>();
};

// Passes everything on to two sinks, which outlive it.
class Tee final : public SensorSink {
 public:
  Tee(SensorSink* a, SensorSink* b) : a_(a), b_(b) {}
  void OnImu(const sensor::ImuSample& sample) override {
    a_->OnImu(sample);
    b_->OnImu(sample);
  }
  void OnPacket(const sensor::LidarPacket& packet) override {
    a_->OnPacket(packet);
    b_->OnPacket(packet);
  }

 private:
  SensorSink* a_;
  SensorSink* b_;
};

}  // namespace mapweld::odometry
