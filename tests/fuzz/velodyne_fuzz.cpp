// SPDX-License-Identifier: Apache-2.0
// The input is a packet. When it is refused as it is, it is decoded once more with its size, flags, azimuths and model
// made right. The size chooses the model.
#include <array>
#include <cmath>
#include <memory>

#include "drivers/lidar/velodyne_codec.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/unit/drivers/lidar/velodyne_packet.hpp"

namespace mapweld::fuzz {
namespace {

constexpr std::array kModels{&lidar::kVlp16, &lidar::kHdl32e, &lidar::kVlp32c};

bool Run(lidar::VelodyneCodec* codec, const Bytes& payload) {
  static sensor::LidarPacket packet;
  const std::uint64_t before = codec->counters().packets + codec->counters().Rejected();
  const Status status = codec->Decode(payload, {}, &packet);
  FUZZ_REQUIRE(codec->counters().packets + codec->counters().Rejected() == before + 1);
  FUZZ_REQUIRE(status == Status::kOk || packet.points.empty());
  FUZZ_REQUIRE(packet.azimuth_first_cdeg < 36000 && packet.azimuth_last_cdeg < 36000);
  for (const sensor::LidarPoint& point : packet.points) {
    const float range2 = point.x * point.x + point.y * point.y + point.z * point.z;
    FUZZ_REQUIRE(range2 > 1e-6F && range2 < 262.2F * 262.2F);
    FUZZ_REQUIRE(point.ring < 32 && point.dt_ns >= 0 && point.dt_ns < 1'330'000);
  }
  return status == Status::kOk;
}

// Made once: the tables of a codec cost as much as a packet. Only the clock remembers anything of the packets before.
lidar::VelodyneCodec& FreshCodec(std::size_t model, time::ClockMode mode) {
  static std::array codecs{lidar::VelodyneCodec(lidar::kVlp16), lidar::VelodyneCodec(lidar::kHdl32e),
                           lidar::VelodyneCodec(lidar::kVlp32c)};
  time::SensorClockOptions options = time::kLidarHourClock;
  options.mode = mode;
  codecs[model].clock() = time::SensorClock(options);
  return codecs[model];
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
  const std::size_t model = size / 2 % fuzz::kModels.size();
  const time::ClockMode mode = size % 2 == 0 ? time::ClockMode::kShared : time::ClockMode::kReceive;
  fuzz::Bytes payload(data, data + size);
  if (fuzz::Run(&fuzz::FreshCodec(model, mode), payload)) return 0;
  payload.resize(VelodynePacket::kPayloadBytes);
  for (std::size_t block = 0; block < VelodynePacket::kBlocks; ++block) {
    payload[block * VelodynePacket::kBlockBytes] = 0xFF;
    payload[block * VelodynePacket::kBlockBytes + 1] = 0xEE;
    payload[block * VelodynePacket::kBlockBytes + 3] %= 140;  // below 36000
  }
  payload[VelodynePacket::kModeAt] =
      static_cast<std::uint8_t>(VelodynePacket::kStrongest + payload[VelodynePacket::kModeAt] % 3);
  payload[VelodynePacket::kModelAt] = fuzz::kModels[model]->model_byte;
  (void)fuzz::Run(&fuzz::FreshCodec(model, mode), payload);
  return 0;
}
