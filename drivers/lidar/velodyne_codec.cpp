// SPDX-License-Identifier: Apache-2.0
#include "drivers/lidar/velodyne_codec.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/byte_io.hpp"

namespace mapweld::lidar {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

std::uint16_t ReadU16(std::span<const std::uint8_t> bytes, std::size_t at) {
  return ByteReader(bytes.subspan(at, 2)).Little<std::uint16_t>();
}

}  // namespace

VelodyneCodec::VelodyneCodec(const VelodyneModel& model, time::ClockMode clock_mode)
    : LidarCodec(clock_mode), model_(model) {
  const std::span<const double> elevations = std::span(model.elevation_deg).first(model.lasers);
  for (std::size_t laser = 0; laser < model.lasers; ++laser) {
    const double elevation_deg = elevations[laser];
    beams_[laser] = {
        .cos_elevation = std::cos(elevation_deg * kDeg),
        .sin_elevation = std::sin(elevation_deg * kDeg),
        .azimuth_rad = model.azimuth_deg[laser] * kDeg,
        .delay_ps = static_cast<std::int64_t>(laser / model.lasers_at_once) * model.laser_period_ps,
        .ring = static_cast<std::uint16_t>(
            std::ranges::count_if(elevations, [&](double other) { return other < elevation_deg; })),
    };
  }
}

Status VelodyneCodec::Check(std::span<const std::uint8_t> payload) {
  if (payload.size() != VelodynePacket::kPayloadBytes) return Refuse(&counters_.wrong_size);
  if (payload[VelodynePacket::kModelAt] != model_.model_byte) return Refuse(&counters_.wrong_model);
  const std::uint8_t mode = payload[VelodynePacket::kModeAt];
  const bool known =
      mode == VelodynePacket::kStrongest || mode == VelodynePacket::kLast || mode == VelodynePacket::kDual;
  return known ? Status::kOk : Refuse(&counters_.wrong_mode);
}

Status VelodyneCodec::ReadAzimuths(std::span<const std::uint8_t> payload, Azimuths* azimuth_cdeg) {
  for (std::size_t block = 0; block < VelodynePacket::kBlocks; ++block) {
    const std::size_t at = block * VelodynePacket::kBlockBytes;
    if (ReadU16(payload, at) != VelodynePacket::kBlockFlag) return Refuse(&counters_.wrong_flag);
    (*azimuth_cdeg)[block] = ReadU16(payload, at + 2);
    if ((*azimuth_cdeg)[block] >= VelodynePacket::kTurnCdeg) return Refuse(&counters_.wrong_azimuth);
  }
  return Status::kOk;
}

// step_cdeg: rotation during the firings of a block.
void VelodyneCodec::DecodeBlock(std::span<const std::uint8_t> payload, std::size_t block, bool dual,
                                double azimuth_cdeg, double step_cdeg, sensor::LidarPacket* packet) const {
  const std::size_t begin = block * VelodynePacket::kBlockBytes + 4;
  const std::size_t time_slot = dual ? block / 2 : block;
  const bool second_return = dual && block % 2 == 1;
  const std::size_t firings = VelodynePacket::kReturns / model_.lasers;
  const std::int64_t block_period_ps = static_cast<std::int64_t>(firings) * model_.firing_period_ps;
  for (std::size_t i = 0; i < VelodynePacket::kReturns; ++i) {
    const std::size_t at = begin + 3 * i;
    const std::uint16_t raw = ReadU16(payload, at);
    if (raw == 0) continue;  // no return
    if (second_return && ReadU16(payload, at - VelodynePacket::kBlockBytes) == raw) continue;
    const Beam& beam = beams_[i % model_.lasers];
    const std::int64_t in_block_ps =
        static_cast<std::int64_t>(i / model_.lasers) * model_.firing_period_ps + beam.delay_ps;
    const std::int64_t dt_ps = static_cast<std::int64_t>(time_slot) * block_period_ps + in_block_ps;
    const double turned = static_cast<double>(in_block_ps) / static_cast<double>(block_period_ps);
    const double azimuth = (azimuth_cdeg + step_cdeg * turned) * 0.01 * kDeg + beam.azimuth_rad;
    const double range_m = raw * model_.distance_unit_m;
    const double level_m = range_m * beam.cos_elevation;
    sensor::LidarPoint point;
    point.x = static_cast<float>(level_m * std::cos(azimuth));
    point.y = static_cast<float>(-level_m * std::sin(azimuth));
    point.z = static_cast<float>(range_m * beam.sin_elevation);
    point.intensity = static_cast<float>(payload[at + 2]);
    point.dt_ns = static_cast<std::int32_t>((dt_ps + 500) / 1000);
    point.ring = beam.ring;
    (void)packet->points.TryPush(point);  // the capacity covers a whole packet, see the static_assert
  }
}

Status VelodyneCodec::DecodeInto(std::span<const std::uint8_t> payload, TimeNs receive, sensor::LidarPacket* packet) {
  if (const Status status = Check(payload); status != Status::kOk) return status;
  Azimuths azimuth_cdeg;
  if (const Status status = ReadAzimuths(payload, &azimuth_cdeg); status != Status::kOk) return status;
  const std::uint32_t us = ByteReader(payload.subspan(VelodynePacket::kTimeAt, 4)).Little<std::uint32_t>();
  if (const Status status = ToTime(us, receive, &packet->t); status != Status::kOk) return status;
  packet->azimuth_first_cdeg = azimuth_cdeg.front();
  packet->azimuth_last_cdeg = azimuth_cdeg.back();

  const bool dual = payload[VelodynePacket::kModeAt] == VelodynePacket::kDual;
  const std::size_t stride = dual ? 2 : 1;
  int step_cdeg = 0;
  for (std::size_t block = 0; block < VelodynePacket::kBlocks; ++block) {
    // The last block has no successor and turns on as the one before it.
    const std::size_t next = block - block % stride + stride;
    if (next < VelodynePacket::kBlocks) {
      const int step =
          (azimuth_cdeg[next] + VelodynePacket::kTurnCdeg - azimuth_cdeg[block]) % VelodynePacket::kTurnCdeg;
      if (step <= kMaxStepCdeg) {
        step_cdeg = step;
      } else {
        ++counters_.odd_steps;
      }
    }
    DecodeBlock(payload, block, dual, azimuth_cdeg[block], step_cdeg, packet);
  }
  return Status::kOk;
}

}  // namespace mapweld::lidar
