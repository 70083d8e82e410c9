// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/velodyne_encoder.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/byte_io.hpp"

namespace mapweld::sim {
namespace {

VelodyneReturn InUnits(const LidarReturn& r) {
  if (r.distance_m <= 0) return {};
  const double units = std::round(static_cast<double>(r.distance_m) / VelodynePacket::kDistanceUnit_m);
  return {static_cast<std::uint16_t>(std::clamp(units, 1.0, 65535.0)), r.reflectivity};
}

}  // namespace

std::int64_t VelodyneColumns(const LidarModel& model, bool dual) {
  if (model.name == "vlp16") return dual ? 12 : 24;
  if (model.name == "hdl32e") return dual ? 6 : 12;
  return 0;
}

VelodynePacket FireVelodynePacket(const LidarSimulator& lidar, std::int64_t index, bool dual) {
  const std::int64_t columns = VelodyneColumns(lidar.model(), dual);
  const std::size_t beams = lidar.model().beams.size();
  const std::size_t columns_per_block = VelodynePacket::kReturnsPerBlock / beams;
  VelodynePacket packet;
  packet.model = beams == 16 ? VelodynePacket::kVlp16 : VelodynePacket::kHdl32e;
  packet.mode = dual ? VelodynePacket::kDualReturn : VelodynePacket::kStrongestReturn;
  packet.us_past_hour = static_cast<std::uint32_t>(lidar.PastHour_ns(index * columns) / 1000 % 3'600'000'000);
  const std::size_t stride = dual ? 2 : 1;
  std::vector<LidarReturn> returns;
  std::vector<LidarReturn> last;
  for (std::int64_t i = 0; i < columns; ++i) {
    const std::int64_t column = index * columns + i;
    const std::size_t block = static_cast<std::size_t>(i) / columns_per_block * stride;
    const std::size_t half = static_cast<std::size_t>(i) % columns_per_block;
    if (half == 0) {
      const long azimuth_cdeg = std::lround(lidar.Azimuth_deg(column) * 100) % 36000;
      std::fill_n(packet.azimuth_cdeg.begin() + static_cast<std::ptrdiff_t>(block), stride,
                  static_cast<std::uint16_t>(azimuth_cdeg));
    }
    if (dual) {
      lidar.DualColumn(column, &returns, &last);
    } else {
      lidar.Column(column, &returns);
    }
    for (std::size_t beam = 0; beam < beams; ++beam) {
      if (dual) packet.returns[block][half * beams + beam] = InUnits(last[beam]);
      packet.returns[block + stride - 1][half * beams + beam] = InUnits(returns[beam]);
    }
  }
  return packet;
}

std::array<std::uint8_t, VelodynePacket::kPayloadBytes> EncodeVelodyne(const VelodynePacket& packet) {
  constexpr std::uint16_t kBlockFlag = 0xFFEE;  // as a number; on the wire the bytes FF EE
  std::array<std::uint8_t, VelodynePacket::kPayloadBytes> bytes{};
  ByteWriter writer(bytes);
  for (std::size_t block = 0; block < VelodynePacket::kBlocks; ++block) {
    writer.Big(kBlockFlag);
    writer.Little(packet.azimuth_cdeg[block]);
    for (const VelodyneReturn& r : packet.returns[block]) {
      writer.Little(r.distance_2mm);
      writer.Little(r.reflectivity);
    }
  }
  writer.Little(packet.us_past_hour);
  writer.Little(packet.mode);
  writer.Little(packet.model);
  return bytes;
}

}  // namespace mapweld::sim
