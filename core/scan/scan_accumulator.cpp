// SPDX-License-Identifier: Apache-2.0
#include "core/scan/scan_accumulator.hpp"

namespace mapweld::scan {

bool ScanAccumulator::Completes(const sensor::LidarPacket& packet) const {
  const bool passed_zero = packet.azimuth_first_cdeg < last_azimuth_cdeg_;
  return open_ && (passed_zero || packet.t - scan_.t_begin > kMaxDuration);
}

Status ScanAccumulator::Add(const sensor::LidarPacket& packet, sensor::Scan* finished, bool* has_scan) {
  *has_scan = false;
  if (packet.t <= newest_packet_) {
    ++stale_packets_;
    return Status::kStale;
  }
  newest_packet_ = packet.t;

  if (Completes(packet)) *has_scan = Flush(finished);
  if (!open_) {
    scan_.points.clear();
    scan_.t_begin = packet.t;
    scan_.t_end = packet.t;
    open_ = true;
  }
  // A packet whose last block is past the zero belongs to the old revolution; the next one starts the new.
  last_azimuth_cdeg_ = packet.azimuth_last_cdeg < packet.azimuth_first_cdeg ? 36000 : packet.azimuth_last_cdeg;

  const std::int64_t since_begin = (packet.t - scan_.t_begin).ns;
  Status status = Status::kOk;
  for (sensor::LidarPoint point : packet.points) {
    point.dt_ns += static_cast<std::int32_t>(since_begin);
    if (scan_.points.TryPush(point) != Status::kOk) {
      ++dropped_points_;
      status = Status::kFull;
      continue;
    }
    const TimeNs fired{scan_.t_begin.ns + point.dt_ns};
    if (fired > scan_.t_end) scan_.t_end = fired;
  }
  return status;
}

bool ScanAccumulator::Flush(sensor::Scan* finished) {
  if (!open_) return false;
  open_ = false;
  last_azimuth_cdeg_ = 0;
  if (scan_.points.empty()) return false;
  *finished = scan_;
  return true;
}

}  // namespace mapweld::scan
