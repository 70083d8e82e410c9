// SPDX-License-Identifier: Apache-2.0
// One drive's LiDAR datagrams and CAN frames in the order of their stamps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "tools/replay/can_log.hpp"
#include "tools/replay/lidar_capture.hpp"

namespace mapweld::replay {

struct Event {
  std::int64_t stamp_ns = 0;
  std::span<const std::uint8_t> lidar;  // a datagram's payload, valid until the next call; empty: a CAN frame
  can::CanFrame frame;
};

class EventSource {
 public:
  virtual ~EventSource() = default;
  virtual bool Next(Event* event) = 0;  // false at the end
};

// `dir`/lidar.pcap and, when wanted, `dir`/imu.candump. On equal stamps the CAN frame comes first, so that the IMU is
// never behind the LiDAR. Throws std::runtime_error, see the two readers.
class Recording final : public EventSource {
 public:
  Recording(const std::filesystem::path& dir, bool with_can);
  bool Next(Event* event) override;
  [[nodiscard]] bool truncated() const { return lidar_.truncated(); }

 private:
  LidarCapture lidar_;
  std::optional<CanLog> can_;
  LidarCapture::Datagram next_datagram_;
  can::CanFrame next_frame_;
  bool has_datagram_ = false;
  bool has_frame_ = false;
  bool datagram_taken_ = true;  // its bytes must stay until the caller is done with them
};

}  // namespace mapweld::replay
