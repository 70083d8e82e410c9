// SPDX-License-Identifier: Apache-2.0
// One lidar packet of an Ouster OS sensor into points. Source: the sensor's software user manual (lidar data formats).
//   16 columns of all beams, of one of four profiles: legacy (firmware 1 and 2) or, from firmware 2.3 on, single
//   return, low data rate and dual return, each with its own size. Angles, columns per turn and profile come from the
//   sensor's metadata; without them every packet is refused.
// The lidar frame of the manual has x towards the connector; ours is turned by half a turn about z, so that x points
// away from it. Columns that the sensor marks invalid are left out. Cost: at most 2048 points, some 50 us. No heap.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/lidar/beam_table.hpp"
#include "drivers/lidar/lidar_codec.hpp"

namespace mapweld::lidar {

struct Ouster {
  static constexpr std::size_t kColumns = 16;             // per packet
  static constexpr std::size_t kHeaderBytes = 32;         // of a packet, not in the legacy profile; as many at its end
  static constexpr std::size_t kColumnHeader = 12;        // u64 ns, u16 column of the turn, u16 status
  static constexpr std::size_t kLegacyHeader = 16;        // u64 ns, u16 column, u16 frame, u32 encoder
  static constexpr std::size_t kLegacyFooter = 4;         // status, all ones when valid
  static constexpr std::int64_t kMaxSpanNs = 50'000'000;  // of one packet: 16 of 512 columns at 5 Hz take 6 ms
};

// How one profile lays out a packet.
struct OusterLayout {
  std::size_t header_bytes = 0;
  std::size_t column_header_bytes = 0;
  std::size_t pixel_bytes = 0;
  std::size_t column_bytes = 0;
  std::size_t packet_bytes = 0;
};
OusterLayout LayoutOf(OusterProfile profile, std::size_t beams);

static_assert(kCap.packet_points >= Ouster::kColumns * BeamTable::kMaxBeams * 2);

class OusterCodec final : public LidarCodec {
 public:
  explicit OusterCodec(time::ClockMode clock_mode = time::ClockMode::kShared) : LidarCodec(clock_mode) {}

  void Configure(const OusterMetadata& metadata);

 private:
  struct Beam {
    double cos_elevation = 1;
    double sin_elevation = 0;
    double azimuth_rad = 0;
    std::uint16_t ring = 0;
  };
  struct Column {
    std::uint64_t t_ns = 0;
    std::uint16_t index = 0;
    bool valid = false;
    std::span<const std::uint8_t> pixels;
  };
  struct Return {
    std::uint32_t range_mm = 0;
    float reflectivity = 0;
  };

  Status DecodeInto(std::span<const std::uint8_t> payload, TimeNs receive, sensor::LidarPacket* packet) override;
  [[nodiscard]] Column ReadColumn(std::span<const std::uint8_t> payload, std::size_t i) const;
  [[nodiscard]] std::size_t ReadReturns(std::span<const std::uint8_t> pixel, std::array<Return, 2>* returns) const;
  void DecodeColumn(const Column& column, std::int32_t dt_ns, sensor::LidarPacket* packet) const;

  OusterProfile profile_ = OusterProfile::kLegacy;
  OusterLayout layout_;
  std::uint16_t columns_per_turn_ = 0;  // 0: not configured
  std::size_t beam_count_ = 0;
  double origin_to_beam_m_ = 0;
  std::array<Beam, BeamTable::kMaxBeams> beams_{};
};

}  // namespace mapweld::lidar
