// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/cloud_player.hpp"

#include <cmath>
#include <numbers>

namespace mapweld::odometry {
namespace {

constexpr DurationNs kRevolution = Milliseconds(100);

// Share of the revolution at which a spinning sensor looks along p; 0 and 1 are behind the vehicle.
double SweepShare(const Eigen::Vector3f& p, Sweep sweep) {
  const double from_behind = 0.5 + static_cast<double>(std::atan2(p.y(), p.x())) / (2 * std::numbers::pi);
  return sweep == Sweep::kCounterClockwise ? from_behind : 1.0 - from_behind;
}

}  // namespace

void LoadScan(const io::RecordingFolder& folder, std::size_t i, Sweep sweep, sensor::Scan* scan) {
  const std::vector<TimeNs>& times = folder.times();
  const std::size_t next = i + 1 < times.size() ? i + 1 : i;
  const DurationNs apart = times.size() > 1 ? times[next] - times[next - 1] : kRevolution;
  scan->t_end = times[i];
  scan->t_begin = times[i] - std::min(apart, kRevolution);
  scan->points.clear();
  const auto duration_ns = static_cast<double>((scan->t_end - scan->t_begin).ns);
  for (const Eigen::Vector3f& p : folder.LoadScan(i).points) {
    const double share = sweep == Sweep::kNone ? 1.0 : SweepShare(p, sweep);
    const sensor::LidarPoint point{p.x(), p.y(), p.z(), 0, static_cast<std::int32_t>(share * duration_ns), 0, 0};
    if (scan->points.TryPush(point) != Status::kOk) return;
  }
}

}  // namespace mapweld::odometry
