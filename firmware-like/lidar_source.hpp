// SPDX-License-Identifier: Apache-2.0
// The LiDAR, whichever model it is: a UDP port and the decoder of its packets.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/lidar/hesai_xt32_codec.hpp"
#include "drivers/lidar/ouster_codec.hpp"
#include "drivers/lidar/udp_port.hpp"
#include "drivers/lidar/velodyne_codec.hpp"
#include "firmware-like/options.hpp"

namespace mapweld::executive {

class LidarSource {
 public:
  explicit LidarSource(const Options& options);

  // Reads the sensor's own angles, if a file was given. kIo with errno when it cannot be read, kFull when it is longer
  // than kMaxSetupFileBytes, kBadInput or kVersion when it is not the file of this model.
  Status LoadCalibration(const Options& options);

  // As UdpPort::Open.
  Status Open(const Options& options) { return port_.Open(options.lidar_port); }

  // See UdpPort::Receive and LidarCodec::Decode.
  Status Receive(std::span<const lidar::Datagram>* out) { return port_.Receive(out); }
  Status Decode(const lidar::Datagram& datagram, sensor::LidarPacket* packet) {
    return codec_->Decode(datagram.payload, datagram.receive, packet);
  }

  [[nodiscard]] int fd() const { return port_.fd(); }
  time::SensorClock& clock() { return codec_->clock(); }
  [[nodiscard]] std::uint64_t packets() const { return codec_->counters().packets; }
  [[nodiscard]] std::uint64_t rejected() const { return codec_->counters().Rejected() + port_.counters().too_long; }
  [[nodiscard]] std::uint64_t kernel_drops() const { return port_.counters().kernel_drops; }

 private:
  Status ApplyCalibration(LidarModel model, std::string_view text);

  lidar::UdpPort port_;
  lidar::VelodyneCodec velodyne_;
  lidar::HesaiXt32Codec hesai_;
  lidar::OusterCodec ouster_;
  lidar::LidarCodec* codec_;
};

}  // namespace mapweld::executive
