// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/vlp16_encoder.hpp"

#include "core/base/byte_io.hpp"

namespace mapweld::sim {

std::array<std::uint8_t, Vlp16::kPayloadBytes> EncodeVlp16(const Vlp16Packet& packet) {
  constexpr std::uint16_t kBlockFlag = 0xFFEE;  // as a number; on the wire the bytes FF EE
  std::array<std::uint8_t, Vlp16::kPayloadBytes> bytes{};
  ByteWriter writer(bytes);
  for (std::size_t block = 0; block < Vlp16::kBlocks; ++block) {
    writer.Big(kBlockFlag);
    writer.Little(packet.azimuth_cdeg[block]);
    for (std::size_t half = 0; half < Vlp16::kSequencesPerBlock; ++half) {
      for (const Vlp16Return& r : packet.returns[block * Vlp16::kSequencesPerBlock + half]) {
        writer.Little(r.distance_2mm);
        writer.Little(r.reflectivity);
      }
    }
  }
  writer.Little(packet.us_past_hour);
  writer.Little(Vlp16::kStrongestReturn);
  writer.Little(Vlp16::kModel);
  return bytes;
}

}  // namespace mapweld::sim
