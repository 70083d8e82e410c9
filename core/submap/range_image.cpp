// SPDX-License-Identifier: Apache-2.0
#include "core/submap/range_image.hpp"

#include <algorithm>
#include <cmath>

namespace mapweld::submap {
namespace {

constexpr float kSameSurface_m = 0.5F;   // how far before or behind the place a return may be to come from it
constexpr float kPassing_m = 0.12F;      // how far above or below the place a beam may pass to speak of it
constexpr float kSensorHeight_m = 1.5F;  // over the flattest surface that is met: the road

// The direction of (x, y) as a number from 0 to 4 that rises with the angle: the way round a square, not a circle.
float SquareAngle(float x, float y) {
  const float sum = std::abs(x) + std::abs(y);
  if (!(sum > 0)) return 0;
  const float share = y / sum;
  if (x < 0) return 2 - share;
  return share < 0 ? 4 + share : share;
}

}  // namespace

RangeImage::Direction RangeImage::DirectionOf(const Eigen::Vector3f& p_lidar) {
  Direction out;
  out.horizontal_m = std::sqrt(p_lidar.x() * p_lidar.x() + p_lidar.y() * p_lidar.y());
  out.range_m = std::sqrt(out.horizontal_m * out.horizontal_m + p_lidar.z() * p_lidar.z());
  const float angle = SquareAngle(p_lidar.x(), p_lidar.y());
  out.column = std::min(kColumns - 1, static_cast<std::size_t>(angle * (static_cast<float>(kColumns) / 4)));
  const float tangent = p_lidar.z() / std::max(out.horizontal_m, 1e-3F);
  out.row = tangent / kRowStep + static_cast<float>(kRows) / 2;
  return out;
}

void RangeImage::Build(const sensor::Scan& scan, std::span<const geom::Pose3, kPoses> odom_T_lidar) {
  for (std::size_t i = 0; i < kPoses; ++i) {
    const geom::Pose3 lidar_T_odom = odom_T_lidar[i].Inverse();
    views_[i] = {lidar_T_odom.q.toRotationMatrix().cast<float>(), lidar_T_odom.t.cast<float>()};
  }
  range_ = {};
  const auto duration_ns = static_cast<float>((scan.t_end - scan.t_begin).ns);
  const float poses_per_ns = duration_ns > 0 ? static_cast<float>(kPoses - 1) / duration_ns : 0;
  for (const sensor::LidarPoint& point : scan.points) {
    const Eigen::Vector3f p(point.x, point.y, point.z);
    if (!p.allFinite()) continue;
    const Direction direction = DirectionOf(p);
    if (!(direction.row >= 0 && direction.row < static_cast<float>(kRows))) continue;
    const float steps = direction.range_m * kRangeSteps;
    if (!(steps >= 1 && steps < 65535)) continue;
    std::uint16_t& nearest = range_[direction.column][static_cast<std::size_t>(direction.row)];
    if (nearest == 0 || steps < static_cast<float>(nearest)) nearest = static_cast<std::uint16_t>(steps);
    const float pose = static_cast<float>(point.dt_ns) * poses_per_ns;
    pose_of_column_[direction.column] =
        static_cast<std::uint8_t>(std::clamp(pose, 0.0F, static_cast<float>(kPoses - 1)));
  }
}

Sight RangeImage::Look(const Eigen::Vector3f& p_odom) const {
  // When did the sensor look there? The middle of the scan says about, that moment's own pose exactly.
  Direction place;
  std::size_t pose = kPoses / 2;
  for (int i = 0; i < 2; ++i) {
    place = DirectionOf(views_[pose].lidar_R_odom * p_odom + views_[pose].lidar_t_odom);
    pose = pose_of_column_[place.column];
  }
  if (place.range_m < kMinRange_m || place.range_m > kMaxRange_m) return Sight::kUnknown;
  const float window = kPassing_m / place.horizontal_m / kRowStep;
  const float lowest = place.row - window;
  const float highest = place.row + window;
  if (!(lowest >= 0 && highest < static_cast<float>(kRows))) return Sight::kUnknown;

  std::uint16_t seen = 0;
  float nearest_row = static_cast<float>(kRows);
  for (auto row = static_cast<std::size_t>(lowest); row <= static_cast<std::size_t>(highest); ++row) {
    const std::uint16_t range = range_[place.column][row];
    const float off = std::abs(static_cast<float>(row) + 0.5F - place.row);
    if (range == 0 || off >= nearest_row) continue;
    nearest_row = off;
    seen = range;
  }
  if (seen == 0) return Sight::kUnknown;
  const float behind_m = static_cast<float>(seen) / kRangeSteps - place.range_m;
  if (std::abs(behind_m) <= kSameSurface_m) return Sight::kSurface;
  // A beam that passes a little above a place on the road comes back from the road behind it.
  const float passing = kRowStep * place.range_m + kPassing_m;
  const float clear_m = kSameSurface_m + place.range_m * passing / kSensorHeight_m;
  return behind_m > clear_m ? Sight::kThrough : Sight::kUnknown;
}

}  // namespace mapweld::submap
