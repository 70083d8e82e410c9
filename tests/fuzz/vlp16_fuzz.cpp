// SPDX-License-Identifier: Apache-2.0
// The input is a packet. It is decoded as it is, and once more with its size, flags and model made right.
#include <cmath>
#include <memory>

#include "drivers/lidar/vlp16_codec.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/unit/drivers/lidar/vlp16_packet.hpp"

namespace mapweld::fuzz {
namespace {

void Run(lidar::Vlp16Codec* codec, const Bytes& payload) {
  static sensor::LidarPacket packet;
  const std::uint64_t before = codec->counters().packets + codec->Rejected();
  const Status status = codec->Decode(payload, {}, &packet);
  FUZZ_REQUIRE(codec->counters().packets + codec->Rejected() == before + 1);
  FUZZ_REQUIRE(status == Status::kOk || packet.points.empty());
  FUZZ_REQUIRE(packet.azimuth_first_cdeg < 36000 && packet.azimuth_last_cdeg < 36000);
  for (const sensor::LidarPoint& point : packet.points) {
    const float range_m = std::hypot(point.x, point.y, point.z);
    FUZZ_REQUIRE(range_m > 0.001F && range_m < 131.1F);
    FUZZ_REQUIRE(point.ring < 16 && point.dt_ns >= 0 && point.dt_ns < 1'330'000);
  }
}

}  // namespace

std::vector<Bytes> Seeds() {
  std::vector<Bytes> out;
  for (const std::uint8_t mode : {lidar::Vlp16::kStrongest, lidar::Vlp16::kDual}) {
    lidar::test::PacketBuilder builder(mode);
    builder.Rotate(35'900, 40).Everywhere(5000).Time(3'599'999'000);
    out.emplace_back(builder.bytes().begin(), builder.bytes().end());
  }
  return out;
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld;
  using lidar::Vlp16;
  lidar::Vlp16Codec codec(size % 2 == 0 ? time::ClockMode::kShared : time::ClockMode::kReceive);
  fuzz::Bytes payload(data, data + size);
  fuzz::Run(&codec, payload);
  payload.resize(Vlp16::kPayloadBytes);
  for (std::size_t block = 0; block < Vlp16::kBlocks; ++block) {
    payload[block * Vlp16::kBlockBytes] = 0xFF;
    payload[block * Vlp16::kBlockBytes + 1] = 0xEE;
  }
  payload[Vlp16::kModeAt] = static_cast<std::uint8_t>(Vlp16::kStrongest + payload[Vlp16::kModeAt] % 3);
  payload[Vlp16::kModelAt] = Vlp16::kModelVlp16;
  fuzz::Run(&codec, payload);
  return 0;
}
