// SPDX-License-Identifier: Apache-2.0
// VLP-16 packets, made for tests.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/lidar/vlp16_geometry.hpp"

namespace mapweld::lidar::test {

class PacketBuilder {
 public:
  explicit PacketBuilder(std::uint8_t mode = Vlp16::kStrongest) {
    bytes_[Vlp16::kModeAt] = mode;
    bytes_[Vlp16::kModelAt] = Vlp16::kModelVlp16;
    for (std::size_t block = 0; block < Vlp16::kBlocks; ++block) Put16(block * Vlp16::kBlockBytes, Vlp16::kBlockFlag);
  }
  // Constant rotation; in dual return mode two blocks share an azimuth.
  PacketBuilder& Rotate(int first_cdeg, int step_cdeg) {
    const bool dual = bytes_[Vlp16::kModeAt] == Vlp16::kDual;
    for (std::size_t block = 0; block < Vlp16::kBlocks; ++block) {
      const auto steps = static_cast<int>(dual ? block / 2 : block);
      Azimuth(block, static_cast<std::uint16_t>((first_cdeg + steps * step_cdeg) % Vlp16::kTurnCdeg));
    }
    return *this;
  }
  PacketBuilder& Azimuth(std::size_t block, std::uint16_t cdeg) {
    Put16(block * Vlp16::kBlockBytes + 2, cdeg);
    return *this;
  }
  PacketBuilder& Return(std::size_t block, std::size_t firing, std::size_t laser, std::uint16_t distance_2mm,
                        std::uint8_t intensity = 50) {
    const std::size_t at = block * Vlp16::kBlockBytes + 4 + 3 * (firing * Vlp16::kLasers + laser);
    Put16(at, distance_2mm);
    bytes_[at + 2] = intensity;
    return *this;
  }
  PacketBuilder& Everywhere(std::uint16_t distance_2mm) {
    for (std::size_t block = 0; block < Vlp16::kBlocks; ++block) {
      for (std::size_t i = 0; i < Vlp16::kFiringsPerBlock * Vlp16::kLasers; ++i) {
        Return(block, i / Vlp16::kLasers, i % Vlp16::kLasers, static_cast<std::uint16_t>(distance_2mm + block));
      }
    }
    return *this;
  }
  PacketBuilder& Time(std::uint32_t us) {
    Put16(Vlp16::kTimeAt, static_cast<std::uint16_t>(us));
    Put16(Vlp16::kTimeAt + 2, static_cast<std::uint16_t>(us >> 16U));
    return *this;
  }
  std::array<std::uint8_t, Vlp16::kPayloadBytes>& bytes() { return bytes_; }

 private:
  void Put16(std::size_t at, std::uint16_t value) {
    bytes_[at] = static_cast<std::uint8_t>(value);
    bytes_[at + 1] = static_cast<std::uint8_t>(value >> 8U);
  }
  std::array<std::uint8_t, Vlp16::kPayloadBytes> bytes_{};
};

}  // namespace mapweld::lidar::test
