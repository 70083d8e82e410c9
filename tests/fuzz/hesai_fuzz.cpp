// SPDX-License-Identifier: Apache-2.0
// The input is a PandarXT-32 packet. When it is refused as it is, it is decoded once more with its identification made
// right.
#include <algorithm>
#include <cmath>

#include "drivers/lidar/hesai_xt32_codec.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/unit/drivers/lidar/hesai_packet.hpp"

namespace mapweld::fuzz {
namespace {

bool Run(lidar::HesaiXt32Codec* codec, const Bytes& payload) {
  static sensor::LidarPacket packet;
  const std::uint64_t before = codec->counters().packets + codec->counters().Rejected();
  const Status status = codec->Decode(payload, {1'000'000'000}, &packet);
  FUZZ_REQUIRE(codec->counters().packets + codec->counters().Rejected() == before + 1);
  FUZZ_REQUIRE(status == Status::kOk || packet.points.empty());
  for (const sensor::LidarPoint& point : packet.points) {
    const float range2 = point.x * point.x + point.y * point.y + point.z * point.z;
    FUZZ_REQUIRE(range2 > 9e-6F && range2 < 262.2F * 262.2F);
    FUZZ_REQUIRE(point.ring < 32 && point.dt_ns >= 0 && point.dt_ns < 400'000);
  }
  return status == Status::kOk;
}

// Made once, see velodyne_fuzz.cpp.
lidar::HesaiXt32Codec& FreshCodec(time::ClockMode mode) {
  static lidar::HesaiXt32Codec codec(time::ClockMode::kShared);
  time::SensorClockOptions options = time::kLidarHourClock;
  options.mode = mode;
  codec.clock() = time::SensorClock(options);
  return codec;
}

}  // namespace

std::vector<Bytes> Seeds() {
  std::vector<Bytes> out;
  for (const int mode : {0x37, 0x39}) {
    lidar::test::HesaiBuilder builder(static_cast<std::uint8_t>(mode));
    builder.Rotate(35'900, 18, mode == 0x39 ? 2 : 1).Everywhere(5000).Date(1, 59, 59).Microseconds(999'999);
    out.emplace_back(builder.bytes().begin(), builder.bytes().end());
  }
  return out;
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld;
  using lidar::HesaiXt32;
  const time::ClockMode mode = size % 2 == 0 ? time::ClockMode::kShared : time::ClockMode::kReceive;
  fuzz::Bytes payload(data, data + size);
  if (fuzz::Run(&fuzz::FreshCodec(mode), payload)) return 0;
  payload.resize(HesaiXt32::kPayloadBytes);
  const fuzz::Bytes header{0xEE, 0xFF, 6, 1, 0, 0, 32, 8, 1, 4};
  std::copy(header.begin(), header.end(), payload.begin());
  payload[HesaiXt32::kModeAt] = static_cast<std::uint8_t>(0x37 + payload[HesaiXt32::kModeAt] % 3);
  payload[HesaiXt32::kFactoryAt] = HesaiXt32::kFactoryByte;
  payload[HesaiXt32::kDateAt + 4] %= 60;
  payload[HesaiXt32::kDateAt + 5] %= 60;
  payload[HesaiXt32::kDateAt + 8] %= 15;
  payload[HesaiXt32::kDateAt + 9] = 0;
  for (std::size_t block = 0; block < HesaiXt32::kBlocks; ++block) {
    payload[HesaiXt32::kBlocksAt + block * HesaiXt32::kBlockBytes + 1] %= 140;  // below 36000
  }
  FUZZ_REQUIRE(fuzz::Run(&fuzz::FreshCodec(mode), payload));
  return 0;
}
