// SPDX-License-Identifier: Apache-2.0
#include "tools/replay/recording.hpp"

namespace mapweld::replay {

Recording::Recording(const std::filesystem::path& dir, bool with_can) : lidar_(dir / "lidar.pcap") {
  if (!with_can) return;
  can_.emplace(dir / "imu.candump");
  has_frame_ = can_->Next(&next_frame_);
}

bool Recording::Next(Event* event) {
  if (datagram_taken_) has_datagram_ = lidar_.Next(&next_datagram_);
  datagram_taken_ = false;
  *event = {};
  if (has_frame_ && (!has_datagram_ || next_frame_.receive.ns <= next_datagram_.stamp_ns)) {
    event->stamp_ns = next_frame_.receive.ns;
    event->frame = next_frame_;
    has_frame_ = can_->Next(&next_frame_);
    return true;
  }
  if (!has_datagram_) return false;
  event->stamp_ns = next_datagram_.stamp_ns;
  event->lidar = next_datagram_.payload;
  datagram_taken_ = true;
  return true;
}

}  // namespace mapweld::replay
