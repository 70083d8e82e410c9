// SPDX-License-Identifier: Apache-2.0
#include "drivers/lidar/hesai_xt32_codec.hpp"

#include <cmath>
#include <numbers>

#include "core/base/byte_io.hpp"

namespace mapweld::lidar {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr std::uint16_t kTurnCdeg = 36000;

template <class T>
T Read(std::span<const std::uint8_t> bytes, std::size_t at) {
  return ByteReader(bytes.subspan(at, sizeof(T))).Little<T>();
}

// Returns per firing; 0 for a mode that the sensor does not have.
std::size_t ReturnsOf(std::uint8_t mode) {
  constexpr std::uint8_t kFirst = 0x33;
  constexpr std::uint8_t kStrongest = 0x37;
  constexpr std::uint8_t kLast = 0x38;
  constexpr std::uint8_t kLastStrongest = 0x39;
  constexpr std::uint8_t kLastFirst = 0x3B;
  constexpr std::uint8_t kFirstStrongest = 0x3C;
  if (mode == kFirst || mode == kStrongest || mode == kLast) return 1;
  return mode == kLastStrongest || mode == kLastFirst || mode == kFirstStrongest ? 2 : 0;
}

BeamTable NominalAngles() {
  BeamTable table;
  table.beams = HesaiXt32::kChannels;
  for (std::size_t i = 0; i < table.beams; ++i) table.elevation_deg[i] = 15.0 - static_cast<double>(i);
  return table;
}

}  // namespace

HesaiXt32Codec::HesaiXt32Codec(time::ClockMode clock_mode) : LidarCodec(clock_mode) {
  SetAngles(NominalAngles());
}

void HesaiXt32Codec::SetAngles(const BeamTable& table) {
  const auto rings = RingsByElevation(table);
  for (std::size_t i = 0; i < beams_.size(); ++i) {
    beams_[i] = {.cos_elevation = std::cos(table.elevation_deg[i] * kDeg),
                 .sin_elevation = std::sin(table.elevation_deg[i] * kDeg),
                 .azimuth_rad = table.azimuth_deg[i] * kDeg,
                 .ring = rings[i]};
  }
}

Status HesaiXt32Codec::Check(std::span<const std::uint8_t> payload) {
  if (payload.size() != HesaiXt32::kPayloadBytes) return Refuse(&counters_.wrong_size);
  if (payload[0] != 0xEE || payload[1] != 0xFF) return Refuse(&counters_.wrong_flag);
  // Protocol 6, so many lasers and blocks, distances in units of 4 mm.
  const bool xt32 = payload[2] == 6 && payload[6] == HesaiXt32::kChannels && payload[7] == HesaiXt32::kBlocks &&
                    payload[9] == 4 && payload[HesaiXt32::kFactoryAt] == HesaiXt32::kFactoryByte;
  if (!xt32) return Refuse(&counters_.wrong_model);
  if (ReturnsOf(payload[HesaiXt32::kModeAt]) == 0) return Refuse(&counters_.wrong_mode);
  for (std::size_t block = 0; block < HesaiXt32::kBlocks; ++block) {
    if (Read<std::uint16_t>(payload, HesaiXt32::kBlocksAt + block * HesaiXt32::kBlockBytes) >= kTurnCdeg) {
      return Refuse(&counters_.wrong_azimuth);
    }
  }
  const std::uint8_t second = payload[HesaiXt32::kDateAt + 5];
  const bool time_of_day = payload[HesaiXt32::kDateAt + 4] < 60 && second < 60 &&
                           Read<std::uint32_t>(payload, HesaiXt32::kDateAt + 6) < 1'000'000;
  return time_of_day ? Status::kOk : Refuse(&counters_.wrong_time);
}

// A number behind the last one is a packet that came late, not a loss.
void HesaiXt32Codec::CountLost(std::uint32_t number) {
  const std::uint32_t step = number - last_number_;
  if (numbered_ && step > 0x7FFFFFFF) return;
  constexpr std::uint32_t kRestart = 100'000;  // more than 20 s of packets: the sensor was switched off
  if (numbered_ && step > 1 && step < kRestart) counters_.lost += step - 1;
  numbered_ = true;
  last_number_ = number;
}

void HesaiXt32Codec::DecodeBlock(std::span<const std::uint8_t> payload, std::size_t block, std::size_t returns,
                                 sensor::LidarPacket* packet) const {
  const std::size_t begin = HesaiXt32::kBlocksAt + block * HesaiXt32::kBlockBytes;
  const double block_azimuth = Read<std::uint16_t>(payload, begin) * 0.01 * kDeg;
  const bool second_return = returns == 2 && block % 2 == 1;
  const auto firing_ns = static_cast<std::int32_t>(block / returns) * HesaiXt32::kBlockPeriodNs;
  for (std::size_t channel = 0; channel < HesaiXt32::kChannels; ++channel) {
    const std::size_t at = begin + 2 + 4 * channel;
    const auto raw = Read<std::uint16_t>(payload, at);
    if (raw == 0) continue;  // no return
    if (second_return && Read<std::uint16_t>(payload, at - HesaiXt32::kBlockBytes) == raw) continue;
    const Beam& beam = beams_[channel];
    const double azimuth = block_azimuth + beam.azimuth_rad;
    const double range_m = raw * HesaiXt32::kDistanceUnitM;
    const double level_m = range_m * beam.cos_elevation;
    sensor::LidarPoint point;
    point.x = static_cast<float>(level_m * std::cos(azimuth));
    point.y = static_cast<float>(-level_m * std::sin(azimuth));
    point.z = static_cast<float>(range_m * beam.sin_elevation);
    point.intensity = static_cast<float>(payload[at + 2]);
    point.dt_ns = firing_ns + static_cast<std::int32_t>(channel) * HesaiXt32::kChannelPeriodNs;
    point.ring = beam.ring;
    (void)packet->points.TryPush(point);  // the capacity covers a whole packet, see the static_assert
  }
}

Status HesaiXt32Codec::DecodeInto(std::span<const std::uint8_t> payload, TimeNs receive, sensor::LidarPacket* packet) {
  if (const Status status = Check(payload); status != Status::kOk) return status;
  const std::uint64_t past_hour_s = payload[HesaiXt32::kDateAt + 4] * 60U + payload[HesaiXt32::kDateAt + 5];
  const std::uint64_t us = past_hour_s * 1'000'000 + Read<std::uint32_t>(payload, HesaiXt32::kDateAt + 6);
  if (const Status status = ToTime(us, receive, &packet->t); status != Status::kOk) return status;
  CountLost(Read<std::uint32_t>(payload, HesaiXt32::kNumberAt));

  const std::size_t returns = ReturnsOf(payload[HesaiXt32::kModeAt]);
  const auto last_firing = static_cast<std::int64_t>((HesaiXt32::kBlocks - 1) / returns);
  packet->t.ns +=
      HesaiXt32::kLastBlockNs + HesaiXt32::kFirstChannelNs - last_firing * std::int64_t{HesaiXt32::kBlockPeriodNs};
  packet->azimuth_first_cdeg = Read<std::uint16_t>(payload, HesaiXt32::kBlocksAt);
  packet->azimuth_last_cdeg =
      Read<std::uint16_t>(payload, HesaiXt32::kBlocksAt + (HesaiXt32::kBlocks - 1) * HesaiXt32::kBlockBytes);
  for (std::size_t block = 0; block < HesaiXt32::kBlocks; ++block) DecodeBlock(payload, block, returns, packet);
  return Status::kOk;
}

}  // namespace mapweld::lidar
