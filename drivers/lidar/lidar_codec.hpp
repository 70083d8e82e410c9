// SPDX-License-Identifier: Apache-2.0
// What every LiDAR decoder has in common: one UDP payload in, points in the lidar frame (x forward, y left, z up, at
// the sensor's optical centre) out. A packet is refused whole: no point comes from a packet that is wrong anywhere.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/status.hpp"
#include "core/sensor/lidar_packet.hpp"
#include "drivers/time/sensor_clock.hpp"

namespace mapweld::lidar {

struct CodecCounters {
  std::uint64_t packets = 0;  // decoded
  std::uint64_t points = 0;
  std::uint64_t odd_steps = 0;  // azimuth steps that are not rotation, replaced by the step before
  std::uint64_t lost = 0;       // packets missing by the sensor's own numbering, where it has one
  // refused packets
  std::uint64_t wrong_size = 0;
  std::uint64_t wrong_flag = 0;     // a block or the header does not start as it must
  std::uint64_t wrong_mode = 0;     // return mode unknown
  std::uint64_t wrong_model = 0;    // another sensor
  std::uint64_t wrong_azimuth = 0;  // a full turn or more
  std::uint64_t wrong_time = 0;     // beyond the clock's range, or a jump
  std::uint64_t empty = 0;          // the sensor marked all of it invalid

  [[nodiscard]] std::uint64_t Rejected() const {
    return wrong_size + wrong_flag + wrong_mode + wrong_model + wrong_azimuth + wrong_time + empty;
  }
};

class LidarCodec {
 public:
  LidarCodec(const LidarCodec&) = delete;
  LidarCodec& operator=(const LidarCodec&) = delete;

  // kBadInput, kEmpty, or the status of the clock for the time stamp; *packet is then without points.
  Status Decode(std::span<const std::uint8_t> payload, TimeNs receive, sensor::LidarPacket* packet) {
    packet->points.clear();
    const Status status = DecodeInto(payload, receive, packet);
    if (status == Status::kOk) {
      ++counters_.packets;
      counters_.points += packet->points.size();
    } else {
      packet->points.clear();
    }
    return status;
  }

  [[nodiscard]] const CodecCounters& counters() const { return counters_; }
  time::SensorClock& clock() { return clock_; }

 protected:
  explicit LidarCodec(time::ClockMode mode) : clock_(ClockFor(mode)) {}
  ~LidarCodec() = default;  // never deleted through this type

  // Counts the cause of every refusal.
  virtual Status DecodeInto(std::span<const std::uint8_t> payload, TimeNs receive, sensor::LidarPacket* packet) = 0;

  static Status Refuse(std::uint64_t* cause) {
    ++*cause;
    return Status::kBadInput;
  }
  // us: microseconds past the hour.
  Status ToTime(std::uint64_t us, TimeNs receive, TimeNs* t) {
    const Status status = clock_.ToTime(us, receive, t);
    if (status != Status::kOk) ++counters_.wrong_time;
    return status;
  }

  CodecCounters counters_;

 private:
  static constexpr time::SensorClockOptions ClockFor(time::ClockMode mode) {
    time::SensorClockOptions options = time::kLidarHourClock;
    options.mode = mode;
    return options;
  }
  time::SensorClock clock_;
};

}  // namespace mapweld::lidar
