// SPDX-License-Identifier: Apache-2.0
// PandarXT-32 packets, made for tests.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/lidar/hesai_xt32_codec.hpp"

namespace mapweld::lidar::test {

class HesaiBuilder {
 public:
  explicit HesaiBuilder(std::uint8_t mode = 0x37) {
    const std::array<std::uint8_t, 12> header{0xEE, 0xFF, 6, 1, 0, 0, 32, 8, 1, 4, 1, 0};
    std::copy(header.begin(), header.end(), bytes_.begin());
    bytes_[HesaiXt32::kModeAt] = mode;
    bytes_[HesaiXt32::kFactoryAt] = HesaiXt32::kFactoryByte;
    Date(10, 20, 30);
  }
  HesaiBuilder& Azimuth(std::size_t block, std::uint16_t cdeg) {
    return Put(HesaiXt32::kBlocksAt + block * HesaiXt32::kBlockBytes, cdeg, 2);
  }
  HesaiBuilder& Rotate(int first_cdeg, int step_cdeg, int blocks_per_firing = 1) {
    for (int block = 0; block < 8; ++block) {
      Azimuth(static_cast<std::size_t>(block),
              static_cast<std::uint16_t>((first_cdeg + block / blocks_per_firing * step_cdeg) % 36000));
    }
    return *this;
  }
  HesaiBuilder& Return(std::size_t block, std::size_t channel, std::uint16_t distance_4mm,
                       std::uint8_t intensity = 50) {
    const std::size_t at = HesaiXt32::kBlocksAt + block * HesaiXt32::kBlockBytes + 2 + 4 * channel;
    bytes_[at + 2] = intensity;
    return Put(at, distance_4mm, 2);
  }
  HesaiBuilder& Everywhere(std::uint16_t distance_4mm) {
    for (std::size_t i = 0; i < 256; ++i) Return(i / 32, i % 32, static_cast<std::uint16_t>(distance_4mm + i));
    return *this;
  }
  HesaiBuilder& Date(std::uint8_t hour, std::uint8_t minute, std::uint8_t second) {
    const std::array<std::uint8_t, 6> date{124, 2, 29, hour, minute, second};
    std::copy(date.begin(), date.end(), bytes_.begin() + HesaiXt32::kDateAt);
    return *this;
  }
  HesaiBuilder& Microseconds(std::uint32_t us) { return Put(HesaiXt32::kDateAt + 6, us, 4); }
  HesaiBuilder& Number(std::uint32_t number) { return Put(HesaiXt32::kNumberAt, number, 4); }
  std::array<std::uint8_t, HesaiXt32::kPayloadBytes>& bytes() { return bytes_; }

 private:
  HesaiBuilder& Put(std::size_t at, std::uint32_t value, unsigned bytes) {
    for (unsigned i = 0; i < bytes; ++i) bytes_[at + i] = static_cast<std::uint8_t>(value >> (8U * i));
    return *this;
  }
  std::array<std::uint8_t, HesaiXt32::kPayloadBytes> bytes_{};
};

}  // namespace mapweld::lidar::test
