// SPDX-License-Identifier: Apache-2.0
// Collects LiDAR packets into revolutions.
#pragma once

#include <cstdint>

#include "core/base/status.hpp"
#include "core/sensor/lidar_packet.hpp"
#include "core/sensor/scan.hpp"

namespace mapweld::scan {

// A revolution ends when the azimuth passes the sensor's zero, or after kMaxDuration when azimuths cannot be trusted.
// Cost per packet: one copy of its points.
class ScanAccumulator {
 public:
  static constexpr DurationNs kMaxDuration = Milliseconds(250);

  // Would this packet end the revolution that is being collected?
  [[nodiscard]] bool Completes(const sensor::LidarPacket& packet) const;

  // Takes one packet. When it begins a new revolution the finished one is copied to *finished and *has_scan is set.
  // kStale: the packet is older than the newest one (reordered or duplicated) and is dropped.
  // kFull: the revolution already holds kCap.scan_points; the points beyond are dropped and counted.
  Status Add(const sensor::LidarPacket& packet, sensor::Scan* finished, bool* has_scan);

  // Hands out what has been collected so far, if anything, and starts afresh.
  bool Flush(sensor::Scan* finished);

  [[nodiscard]] std::uint64_t stale_packets() const { return stale_packets_; }
  [[nodiscard]] std::uint64_t dropped_points() const { return dropped_points_; }

 private:
  sensor::Scan scan_;
  bool open_ = false;
  TimeNs newest_packet_{INT64_MIN};
  std::uint16_t last_azimuth_cdeg_ = 0;
  std::uint64_t stale_packets_ = 0;
  std::uint64_t dropped_points_ = 0;
};

}  // namespace mapweld::scan
