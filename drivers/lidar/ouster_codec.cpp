// SPDX-License-Identifier: Apache-2.0
#include "drivers/lidar/ouster_codec.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/byte_io.hpp"

namespace mapweld::lidar {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

template <class T>
T Read(std::span<const std::uint8_t> bytes, std::size_t at) {
  return ByteReader(bytes.subspan(at, sizeof(T))).Little<T>();
}

std::size_t PixelBytes(OusterProfile profile) {
  switch (profile) {
    case OusterProfile::kLowRate:
      return 4;
    case OusterProfile::kDual:
      return 16;
    case OusterProfile::kLegacy:
    case OusterProfile::kSingle:
      break;
  }
  return 12;
}

}  // namespace

OusterLayout LayoutOf(OusterProfile profile, std::size_t beams) {
  const bool legacy = profile == OusterProfile::kLegacy;
  OusterLayout layout;
  layout.header_bytes = legacy ? 0 : Ouster::kHeaderBytes;
  layout.column_header_bytes = legacy ? Ouster::kLegacyHeader : Ouster::kColumnHeader;
  layout.pixel_bytes = PixelBytes(profile);
  layout.column_bytes = layout.column_header_bytes + beams * layout.pixel_bytes + (legacy ? Ouster::kLegacyFooter : 0);
  layout.packet_bytes = 2 * layout.header_bytes + Ouster::kColumns * layout.column_bytes;
  return layout;
}

void OusterCodec::Configure(const OusterMetadata& metadata) {
  profile_ = metadata.profile;
  beam_count_ = metadata.beams.beams;
  layout_ = LayoutOf(profile_, beam_count_);
  columns_per_turn_ = metadata.columns_per_turn;
  origin_to_beam_m_ = metadata.origin_to_beam_mm * 1e-3;
  const auto rings = RingsByElevation(metadata.beams);
  for (std::size_t i = 0; i < beam_count_; ++i) {
    const double elevation = metadata.beams.elevation_deg[i] * kDeg;
    beams_[i] = {.cos_elevation = std::cos(elevation),
                 .sin_elevation = std::sin(elevation),
                 .azimuth_rad = metadata.beams.azimuth_deg[i] * kDeg,
                 .ring = rings[i]};
  }
}

OusterCodec::Column OusterCodec::ReadColumn(std::span<const std::uint8_t> payload, std::size_t i) const {
  const auto bytes = payload.subspan(layout_.header_bytes + i * layout_.column_bytes, layout_.column_bytes);
  Column column;
  column.t_ns = Read<std::uint64_t>(bytes, 0);
  column.index = Read<std::uint16_t>(bytes, 8);
  column.valid = profile_ == OusterProfile::kLegacy
                     ? Read<std::uint32_t>(bytes, bytes.size() - Ouster::kLegacyFooter) == 0xFFFFFFFF
                     : (Read<std::uint16_t>(bytes, 10) & 1U) != 0;
  column.pixels = bytes.subspan(layout_.column_header_bytes, beam_count_ * layout_.pixel_bytes);
  return column;
}

// How many there are; a second return equal to the first is left out.
std::size_t OusterCodec::ReadReturns(std::span<const std::uint8_t> pixel, std::array<Return, 2>* returns) const {
  auto& [first, second] = *returns;
  const auto word = Read<std::uint32_t>(pixel, 0);
  switch (profile_) {
    case OusterProfile::kLegacy:
      first = {word & 0xFFFFFU, static_cast<float>(std::min<std::uint16_t>(Read<std::uint16_t>(pixel, 4), 255))};
      return 1;
    case OusterProfile::kSingle:
      first = {word & 0x7FFFFU, static_cast<float>(pixel[4])};
      return 1;
    case OusterProfile::kLowRate:
      first = {(word & 0x7FFFU) * 8, static_cast<float>(pixel[2])};
      return 1;
    case OusterProfile::kDual:
      first = {word & 0x7FFFFU, static_cast<float>(pixel[3])};
      second = {Read<std::uint32_t>(pixel, 4) & 0x7FFFFU, static_cast<float>(pixel[7])};
      break;
  }
  return second.range_mm == first.range_mm ? 1 : 2;
}

void OusterCodec::DecodeColumn(const Column& column, std::int32_t dt_ns, sensor::LidarPacket* packet) const {
  const double encoder = 2 * std::numbers::pi * (1.0 - static_cast<double>(column.index) / columns_per_turn_);
  const double origin_x = origin_to_beam_m_ * std::cos(encoder);
  const double origin_y = origin_to_beam_m_ * std::sin(encoder);
  std::array<Return, 2> returns;
  for (std::size_t i = 0; i < beam_count_; ++i) {
    const std::size_t n = ReadReturns(column.pixels.subspan(i * layout_.pixel_bytes, layout_.pixel_bytes), &returns);
    const Beam& beam = beams_[i];
    const double cos_azimuth = std::cos(encoder - beam.azimuth_rad);
    const double sin_azimuth = std::sin(encoder - beam.azimuth_rad);
    for (std::size_t k = 0; k < n; ++k) {
      if (returns[k].range_mm == 0) continue;  // no return
      // Ranges count from the axis; the beam starts origin_to_beam off it.
      const double beam_m = returns[k].range_mm * 1e-3 - origin_to_beam_m_;
      const double level_m = beam_m * beam.cos_elevation;
      sensor::LidarPoint point;
      point.x = static_cast<float>(-(level_m * cos_azimuth + origin_x));
      point.y = static_cast<float>(-(level_m * sin_azimuth + origin_y));
      point.z = static_cast<float>(beam_m * beam.sin_elevation);
      point.intensity = returns[k].reflectivity;
      point.dt_ns = dt_ns;
      point.ring = beam.ring;
      (void)packet->points.TryPush(point);
    }
  }
}

Status OusterCodec::DecodeInto(std::span<const std::uint8_t> payload, TimeNs receive, sensor::LidarPacket* packet) {
  if (columns_per_turn_ == 0 || payload.size() != layout_.packet_bytes) return Refuse(&counters_.wrong_size);
  constexpr std::uint16_t kLidarPacket = 1;
  if (profile_ != OusterProfile::kLegacy && Read<std::uint16_t>(payload, 0) != kLidarPacket) {
    return Refuse(&counters_.wrong_flag);
  }
  std::array<Column, Ouster::kColumns> columns;
  std::size_t n = 0;
  for (std::size_t i = 0; i < Ouster::kColumns; ++i) {
    columns[n] = ReadColumn(payload, i);
    if (!columns[n].valid) continue;
    if (columns[n].index >= columns_per_turn_) return Refuse(&counters_.wrong_azimuth);
    const std::uint64_t since_first = columns[n].t_ns - columns[0].t_ns;
    if (since_first > Ouster::kMaxSpanNs) return Refuse(&counters_.wrong_time);
    ++n;
  }
  if (n == 0) {
    ++counters_.empty;
    return Status::kEmpty;
  }
  constexpr std::uint64_t kHourUs = 3'600'000'000;
  const std::uint64_t first_ns = columns[0].t_ns;
  if (const Status status = ToTime(first_ns / 1000 % kHourUs, receive, &packet->t); status != Status::kOk) {
    return status;
  }
  const auto azimuth_cdeg = [&](const Column& column) {
    return static_cast<std::uint16_t>(column.index * 36000U / columns_per_turn_);
  };
  packet->azimuth_first_cdeg = azimuth_cdeg(columns[0]);
  packet->azimuth_last_cdeg = azimuth_cdeg(columns[n - 1]);
  for (std::size_t i = 0; i < n; ++i) {
    DecodeColumn(columns[i], static_cast<std::int32_t>(columns[i].t_ns - first_ns), packet);
  }
  return Status::kOk;
}

}  // namespace mapweld::lidar
