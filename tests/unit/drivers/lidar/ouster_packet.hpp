// SPDX-License-Identifier: Apache-2.0
// Ouster packets and metadata, made for tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/lidar/ouster_codec.hpp"

namespace mapweld::lidar::test {

inline std::string List(const std::vector<double>& values) {
  std::string text = "[";
  for (const double value : values) text += (text.size() > 1 ? ", " : "") + std::to_string(value);
  return text + "]";
}

// Metadata as the sensor writes it, with beams evenly between +-22.5 degrees, the highest first.
inline std::string OusterJson(std::size_t beams, const std::string& profile = "LEGACY") {
  std::vector<double> elevation;
  std::vector<double> azimuth;
  for (std::size_t i = 0; i < beams; ++i) {
    elevation.push_back(22.5 - 45.0 * static_cast<double>(i) / static_cast<double>(beams - 1));
    azimuth.push_back(i % 2 == 0 ? 3.0 : -1.0);
  }
  return R"({"beam_intrinsics": {"beam_altitude_angles": )" + List(elevation) + R"(, "beam_azimuth_angles": )" +
         List(azimuth) + R"(, "lidar_origin_to_beam_origin_mm": 15.806}, "config_params": {"lidar_mode": "1024x10",)" +
         R"( "udp_profile_lidar": ")" + profile + R"("}})";
}

class OusterBuilder {
 public:
  OusterBuilder(OusterProfile profile, std::size_t beams) : profile_(profile), layout_(LayoutOf(profile, beams)) {
    bytes_.resize(layout_.packet_bytes);
    if (profile != OusterProfile::kLegacy) bytes_[0] = 1;
    for (std::size_t i = 0; i < Ouster::kColumns; ++i) Column(i, 1'000'000'000 + 97'656 * i, i).Valid(i, true);
  }
  OusterBuilder& Column(std::size_t i, std::uint64_t t_ns, std::size_t index) {
    Put(At(i), t_ns, 8);
    return Put(At(i) + 8, index, 2);
  }
  OusterBuilder& Valid(std::size_t i, bool valid) {
    if (profile_ == OusterProfile::kLegacy) {
      return Put(At(i) + layout_.column_bytes - Ouster::kLegacyFooter, valid ? 0xFFFFFFFF : 0, 4);
    }
    return Put(At(i) + 10, valid ? 1 : 0, 2);
  }
  // The first bytes of a pixel, as the profile lays them out.
  OusterBuilder& Pixel(std::size_t column, std::size_t beam, std::uint64_t first_8_bytes) {
    const std::size_t at = At(column) + layout_.column_header_bytes + beam * layout_.pixel_bytes;
    return Put(at, first_8_bytes, layout_.pixel_bytes < 8 ? 4 : 8);
  }
  std::vector<std::uint8_t>& bytes() { return bytes_; }

 private:
  [[nodiscard]] std::size_t At(std::size_t column) const {
    return layout_.header_bytes + column * layout_.column_bytes;
  }
  OusterBuilder& Put(std::size_t at, std::uint64_t value, unsigned bytes) {
    for (unsigned i = 0; i < bytes; ++i) bytes_[at + i] = static_cast<std::uint8_t>(value >> (8U * i));
    return *this;
  }
  OusterProfile profile_;
  OusterLayout layout_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace mapweld::lidar::test
