// SPDX-License-Identifier: Apache-2.0
// Velodyne packets, made for tests.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/lidar/velodyne_models.hpp"

namespace mapweld::lidar::test {

class PacketBuilder {
 public:
  explicit PacketBuilder(std::uint8_t mode = VelodynePacket::kStrongest, const VelodyneModel& model = kVlp16)
      : lasers_(model.lasers) {
    bytes_[VelodynePacket::kModeAt] = mode;
    bytes_[VelodynePacket::kModelAt] = model.model_byte;
    for (std::size_t block = 0; block < VelodynePacket::kBlocks; ++block) {
      Put16(block * VelodynePacket::kBlockBytes, VelodynePacket::kBlockFlag);
    }
  }
  // Constant rotation; in dual return mode two blocks share an azimuth.
  PacketBuilder& Rotate(int first_cdeg, int step_cdeg) {
    const bool dual = bytes_[VelodynePacket::kModeAt] == VelodynePacket::kDual;
    for (std::size_t block = 0; block < VelodynePacket::kBlocks; ++block) {
      const auto steps = static_cast<int>(dual ? block / 2 : block);
      Azimuth(block, static_cast<std::uint16_t>((first_cdeg + steps * step_cdeg) % VelodynePacket::kTurnCdeg));
    }
    return *this;
  }
  PacketBuilder& Azimuth(std::size_t block, std::uint16_t cdeg) {
    Put16(block * VelodynePacket::kBlockBytes + 2, cdeg);
    return *this;
  }
  // distance: in the model's unit, 2 or 4 mm.
  PacketBuilder& Return(std::size_t block, std::size_t firing, std::size_t laser, std::uint16_t distance,
                        std::uint8_t intensity = 50) {
    const std::size_t at = block * VelodynePacket::kBlockBytes + 4 + 3 * (firing * lasers_ + laser);
    Put16(at, distance);
    bytes_[at + 2] = intensity;
    return *this;
  }
  PacketBuilder& Everywhere(std::uint16_t distance) {
    for (std::size_t block = 0; block < VelodynePacket::kBlocks; ++block) {
      for (std::size_t i = 0; i < VelodynePacket::kReturns; ++i) {
        Return(block, 0, i, static_cast<std::uint16_t>(distance + block));
      }
    }
    return *this;
  }
  PacketBuilder& Time(std::uint32_t us) {
    Put16(VelodynePacket::kTimeAt, static_cast<std::uint16_t>(us));
    Put16(VelodynePacket::kTimeAt + 2, static_cast<std::uint16_t>(us >> 16U));
    return *this;
  }
  std::array<std::uint8_t, VelodynePacket::kPayloadBytes>& bytes() { return bytes_; }

 private:
  void Put16(std::size_t at, std::uint16_t value) {
    bytes_[at] = static_cast<std::uint8_t>(value);
    bytes_[at + 1] = static_cast<std::uint8_t>(value >> 8U);
  }
  std::size_t lasers_;
  std::array<std::uint8_t, VelodynePacket::kPayloadBytes> bytes_{};
};

}  // namespace mapweld::lidar::test
