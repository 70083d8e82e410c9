// SPDX-License-Identifier: Apache-2.0
#include "drivers/lidar/vlp16_codec.hpp"

#include <cmath>
#include <cstring>
#include <numbers>

#include "core/base/byte_io.hpp"

namespace mapweld::lidar {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

std::uint16_t ReadU16(std::span<const std::uint8_t> bytes, std::size_t at) {
  return ByteReader(bytes.subspan(at, 2)).Little<std::uint16_t>();
}

constexpr time::SensorClockOptions ClockFor(time::ClockMode mode) {
  time::SensorClockOptions options = time::kVlp16Clock;
  options.mode = mode;
  return options;
}

}  // namespace

Vlp16Codec::Vlp16Codec(time::ClockMode clock_mode) : clock_(ClockFor(clock_mode)) {
  for (std::size_t laser = 0; laser < Vlp16::kLasers; ++laser) {
    cos_elevation_[laser] = std::cos(kVlp16ElevationDeg[laser] * kDeg);
    sin_elevation_[laser] = std::sin(kVlp16ElevationDeg[laser] * kDeg);
  }
}

std::uint64_t Vlp16Codec::Rejected() const {
  const Counters& c = counters_;
  return c.wrong_size + c.wrong_flag + c.wrong_mode + c.wrong_model + c.wrong_azimuth + c.wrong_time;
}

bool Vlp16Codec::Check(std::span<const std::uint8_t> payload) {
  std::uint64_t* cause = nullptr;
  if (payload.size() != Vlp16::kPayloadBytes) {
    cause = &counters_.wrong_size;
  } else if (payload[Vlp16::kModelAt] != Vlp16::kModelVlp16) {
    cause = &counters_.wrong_model;
  } else if (payload[Vlp16::kModeAt] != Vlp16::kStrongest && payload[Vlp16::kModeAt] != Vlp16::kLast &&
             payload[Vlp16::kModeAt] != Vlp16::kDual) {
    cause = &counters_.wrong_mode;
  }
  if (cause == nullptr) return true;
  ++*cause;
  return false;
}

bool Vlp16Codec::ReadAzimuths(std::span<const std::uint8_t> payload, Azimuths* azimuth_cdeg) {
  for (std::size_t block = 0; block < Vlp16::kBlocks; ++block) {
    const std::size_t at = block * Vlp16::kBlockBytes;
    if (ReadU16(payload, at) != Vlp16::kBlockFlag) {
      ++counters_.wrong_flag;
      return false;
    }
    (*azimuth_cdeg)[block] = ReadU16(payload, at + 2);
    if ((*azimuth_cdeg)[block] >= Vlp16::kTurnCdeg) {
      ++counters_.wrong_azimuth;
      return false;
    }
  }
  return true;
}

// step_cdeg: rotation during the two firings of a block.
void Vlp16Codec::DecodeBlock(std::span<const std::uint8_t> payload, std::size_t block, bool dual, double azimuth_cdeg,
                             double step_cdeg, sensor::LidarPacket* packet) const {
  const std::span<const std::uint8_t> data = payload.subspan(block * Vlp16::kBlockBytes + 4, Vlp16::kBlockBytes - 4);
  const std::size_t time_slot = dual ? block / 2 : block;
  const bool second_return = dual && block % 2 == 1;
  constexpr auto kBlockPeriodPs = static_cast<double>(Vlp16::kFiringsPerBlock * Vlp16::kFiringPeriodPs);
  for (std::size_t i = 0; i < Vlp16::kFiringsPerBlock * Vlp16::kLasers; ++i) {
    const std::size_t at = 3 * i;
    const std::uint16_t raw = ReadU16(data, at);
    if (raw == 0) continue;  // no return
    if (second_return && ReadU16(payload, (block - 1) * Vlp16::kBlockBytes + 4 + at) == raw) continue;
    const std::size_t firing = i / Vlp16::kLasers;
    const std::size_t laser = i % Vlp16::kLasers;
    const std::int64_t in_block_ps = static_cast<std::int64_t>(firing) * Vlp16::kFiringPeriodPs +
                                     static_cast<std::int64_t>(laser) * Vlp16::kLaserPeriodPs;
    const std::int64_t dt_ps =
        static_cast<std::int64_t>(time_slot * Vlp16::kFiringsPerBlock) * Vlp16::kFiringPeriodPs + in_block_ps;
    const double azimuth = (azimuth_cdeg + step_cdeg * static_cast<double>(in_block_ps) / kBlockPeriodPs) * 0.01 * kDeg;
    const double range_m = raw * Vlp16::kDistanceUnitM;
    const double level_m = range_m * cos_elevation_[laser];
    sensor::LidarPoint point;
    point.x = static_cast<float>(level_m * std::cos(azimuth));
    point.y = static_cast<float>(-level_m * std::sin(azimuth));
    point.z = static_cast<float>(range_m * sin_elevation_[laser]);
    point.intensity = static_cast<float>(data[at + 2]);
    point.dt_ns = static_cast<std::int32_t>((dt_ps + 500) / 1000);
    point.ring = Vlp16Ring(laser);
    (void)packet->points.TryPush(point);  // the capacity covers a whole packet, see the static_assert
  }
}

Status Vlp16Codec::Decode(std::span<const std::uint8_t> payload, TimeNs receive, sensor::LidarPacket* packet) {
  packet->points.clear();
  Azimuths azimuth_cdeg;
  if (!Check(payload) || !ReadAzimuths(payload, &azimuth_cdeg)) return Status::kBadInput;
  const std::uint32_t us = ByteReader(payload.subspan(Vlp16::kTimeAt, 4)).Little<std::uint32_t>();
  if (const Status status = clock_.ToTime(us, receive, &packet->t); status != Status::kOk) {
    ++counters_.wrong_time;
    return status;
  }
  packet->azimuth_first_cdeg = azimuth_cdeg.front();
  packet->azimuth_last_cdeg = azimuth_cdeg.back();

  const bool dual = payload[Vlp16::kModeAt] == Vlp16::kDual;
  const std::size_t stride = dual ? 2 : 1;
  int step_cdeg = 0;
  for (std::size_t block = 0; block < Vlp16::kBlocks; ++block) {
    // The last block has no successor and turns on as the one before it.
    const std::size_t next = block - block % stride + stride;
    if (next < Vlp16::kBlocks) {
      const int step = (azimuth_cdeg[next] + Vlp16::kTurnCdeg - azimuth_cdeg[block]) % Vlp16::kTurnCdeg;
      if (step <= kMaxStepCdeg) {
        step_cdeg = step;
      } else {
        ++counters_.odd_steps;
      }
    }
    DecodeBlock(payload, block, dual, azimuth_cdeg[block], step_cdeg, packet);
  }
  ++counters_.packets;
  counters_.points += packet->points.size();
  return Status::kOk;
}

}  // namespace mapweld::lidar
