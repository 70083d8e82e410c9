// SPDX-License-Identifier: Apache-2.0
// The input is a packet. It is decoded as it is, and once more with its size, flags,
// azimuths and model made right. The size chooses the model.
#include <array>
#include <cmath>
#include <memory>

#include "drivers/lidar/velodyne_codec.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/unit/drivers/lidar/velodyne_packet.hpp"

namespace mapweld::fuzz {
namespace {

constexpr std::array kModels{&lidar::kVlp16, &lidar::kHdl32e, &lidar::kVlp32c};

void Run(lidar::VelodyneCodec* codec, const Bytes& payload) {
  static sensor::LidarPacket packet;
  const std::uint64_t before = codec->counters().packets + codec->counters().Rejected();
  const Status status = codec->Decode(payload, {}, &packet);
  FUZZ_REQUIRE(codec->counters().packets + codec->counters().Rejected() == before + 1);
  FUZZ_REQUIRE(status == Status::kOk || packet.points.empty());
  FUZZ_REQUIRE(packet.azimuth_first_cdeg < 36000 && packet.azimuth_last_cdeg < 36000);
  for (const sensor::LidarPoint& point : packet.points) {
    const float range_m = std::hypot(point.x, point.y, point.z);
    FUZZ_REQUIRE(range_m > 0.001F && range_m < 262.2F);
    FUZZ_REQUIRE(point.ring < 32 && point.dt_ns >= 0 && point.dt_ns < 1'330'000);
  }
}

}  // namespace

std::vector<Bytes> Seeds() {
  std::vector<Bytes> out;
  for (std::size_t i = 0; i < 2 * kModels.size(); ++i) {
    lidar::test::PacketBuilder builder(i % 2 == 0 ? lidar::VelodynePacket::kStrongest : lidar::VelodynePacket::kDual,
                                       *kModels[i / 2]);
    builder.Rotate(35'900, 40).Everywhere(5000).Time(3'599'999'000);
    out.emplace_back(builder.bytes().begin(), builder.bytes().end());
    out.back().resize(lidar::VelodynePacket::kPayloadBytes + 2 * (i / 2));  // the size chooses the model
  }
  return out;
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld;
  using lidar::VelodynePacket;
  const lidar::VelodyneModel& model = *fuzz::kModels[size / 2 % fuzz::kModels.size()];
  lidar::VelodyneCodec codec(model, size % 2 == 0 ? time::ClockMode::kShared : time::ClockMode::kReceive);
  fuzz::Bytes payload(data, data + size);
  fuzz::Run(&codec, payload);
  payload.resize(VelodynePacket::kPayloadBytes);
  for (std::size_t block = 0; block < VelodynePacket::kBlocks; ++block) {
    payload[block * VelodynePacket::kBlockBytes] = 0xFF;
    payload[block * VelodynePacket::kBlockBytes + 1] = 0xEE;
    payload[block * VelodynePacket::kBlockBytes + 3] %= 140;  // below 36000
  }
  payload[VelodynePacket::kModeAt] =
      static_cast<std::uint8_t>(VelodynePacket::kStrongest + payload[VelodynePacket::kModeAt] % 3);
  payload[VelodynePacket::kModelAt] = model.model_byte;
  fuzz::Run(&codec, payload);
  return 0;
}
