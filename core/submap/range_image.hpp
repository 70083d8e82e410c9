// SPDX-License-Identifier: Apache-2.0
// What one scan saw in which direction, to ask afterwards: was there something at this place, or did the light pass
// through it?
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/config/capacity.hpp"
#include "core/geom/pose3.hpp"
#include "core/sensor/scan.hpp"

namespace mapweld::submap {

enum class Sight {
  kUnknown,  // hidden behind something nearer, not looked at, or not clear
  kSurface,  // a return came from there
  kThrough,  // a beam passed within 12 cm and came back from well behind
};

// The nearest return per direction, in the LiDAR's own frame: what a moving sensor saw at one moment is exact there.
class RangeImage {
 public:
  static constexpr std::size_t kPoses = 65;
  static constexpr float kMinRange_m = 4;
  static constexpr float kMaxRange_m = 40;

  // odom_T_lidar: on an even grid over [scan.t_begin, scan.t_end]. Cost: one pass over the points, without
  // trigonometry.
  void Build(const sensor::Scan& scan, std::span<const geom::Pose3, kPoses> odom_T_lidar);

  // About 60 flops. Places nearer than kMinRange_m or farther than kMaxRange_m are kUnknown.
  [[nodiscard]] Sight Look(const Eigen::Vector3f& p_odom) const;

 private:
  static constexpr std::size_t kColumns = 1024;  // of 0.22 to 0.45 degrees
  static constexpr std::size_t kRows = 192;
  static constexpr float kRowStep = 0.008F;  // of the tangent of the elevation, about 0.45 degrees
  static constexpr float kRangeSteps = 100;  // per metre

  struct Direction {
    std::size_t column = 0;
    float row = 0;  // in steps from the lowest
    float range_m = 0;
    float horizontal_m = 0;
  };
  static Direction DirectionOf(const Eigen::Vector3f& p_lidar);

  struct View {
    Eigen::Matrix3f lidar_R_odom = Eigen::Matrix3f::Identity();
    Eigen::Vector3f lidar_t_odom = Eigen::Vector3f::Zero();
  };
  std::array<View, kPoses> views_;
  std::array<std::uint8_t, kColumns> pose_of_column_{};             // when the sensor looked there
  std::array<std::array<std::uint16_t, kRows>, kColumns> range_{};  // 1/kRangeSteps m; 0: nothing came back
};

}  // namespace mapweld::submap
