// SPDX-License-Identifier: Apache-2.0
// The angles of one individual sensor's beams, as its maker measured them, read once at start from the file that comes
// with the sensor. No heap; one pass over the text.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/status.hpp"

namespace mapweld::lidar {

struct BeamTable {
  static constexpr std::size_t kMaxBeams = 128;

  std::size_t beams = 0;
  std::array<double, kMaxBeams> elevation_deg{};  // upwards
  std::array<double, kMaxBeams> azimuth_deg{};    // offset from the packet's azimuth, clockwise seen from above
};

// The beam's place counted from the lowest, 0..beams-1.
std::array<std::uint16_t, BeamTable::kMaxBeams> RingsByElevation(const BeamTable& table);

// Hesai's angle correction file: a heading line, then `channel,elevation,azimuth` for channels 1..beams in any order.
// kBadInput: a line that is none, a channel missing, twice or out of range, an angle that is not one.
Status ParseHesaiAngles(std::string_view csv, std::size_t beams, BeamTable* table);

enum class OusterProfile : std::uint8_t { kLegacy, kSingle, kLowRate, kDual };

struct OusterMetadata {
  BeamTable beams;
  OusterProfile profile = OusterProfile::kLegacy;
  std::uint16_t columns_per_turn = 0;  // 512, 1024, 2048 or 4096
  double origin_to_beam_mm = 0;        // from the axis of rotation to where beams start
};

// What a decoder needs of an Ouster sensor's metadata (JSON), wherever it stands in it: beam_altitude_angles,
// beam_azimuth_angles, lidar_mode, and, when there, lidar_origin_to_beam_origin_mm and udp_profile_lidar.
// kBadInput: one of the first three missing or not understood; kVersion: a profile that this decoder does not know.
Status ParseOusterMetadata(std::string_view json, OusterMetadata* metadata);

}  // namespace mapweld::lidar
