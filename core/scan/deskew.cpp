// SPDX-License-Identifier: Apache-2.0
#include "core/scan/deskew.hpp"

#include <algorithm>

namespace mapweld::scan {

void Deskew(const sensor::Scan& scan, const ScanMotion& motion, const geom::Pose3& body_T_lidar,
            const DeskewConfig& config, BodyPoints* out) {
  std::array<Eigen::Matrix3f, ScanMotion::kSteps + 1> rotation;
  std::array<Eigen::Vector3f, ScanMotion::kSteps + 1> translation;
  for (std::size_t i = 0; i <= ScanMotion::kSteps; ++i) {
    const geom::Pose3 end_T_lidar = motion.end_T_body[i] * body_T_lidar;
    rotation[i] = end_T_lidar.q.toRotationMatrix().cast<float>();
    translation[i] = end_T_lidar.t.cast<float>();
  }
  const auto duration_ns = static_cast<float>((scan.t_end - scan.t_begin).ns);
  const float steps_per_ns = duration_ns > 0 ? static_cast<float>(ScanMotion::kSteps) / duration_ns : 0.0F;
  const float min_squared = config.min_range_m * config.min_range_m;
  const float max_squared = config.max_range_m * config.max_range_m;

  out->clear();
  for (const sensor::LidarPoint& point : scan.points) {
    const Eigen::Vector3f p(point.x, point.y, point.z);
    const float range_squared = p.squaredNorm();
    if (!(range_squared >= min_squared && range_squared <= max_squared)) continue;  // also refuses NaN
    const float at =
        std::clamp(static_cast<float>(point.dt_ns) * steps_per_ns, 0.0F, static_cast<float>(ScanMotion::kSteps));
    const auto i = std::min(static_cast<std::size_t>(at), ScanMotion::kSteps - 1);
    const float s = at - static_cast<float>(i);
    const Eigen::Vector3f a = rotation[i] * p + translation[i];
    const Eigen::Vector3f b = rotation[i + 1] * p + translation[i + 1];
    (void)out->TryPush({a + s * (b - a)});  // same capacity as the scan: cannot be full
  }
}

}  // namespace mapweld::scan
