// SPDX-License-Identifier: Apache-2.0
// First byte: profile and validity. Then an Ouster packet of 16 beams. When it is refused as it is, it is decoded once
// more with its size, type, validity and columns made right.
#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/lidar/ouster_codec.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/unit/drivers/lidar/ouster_packet.hpp"

namespace mapweld::fuzz {
namespace {

constexpr std::size_t kBeams = 16;
constexpr std::array kProfiles{lidar::OusterProfile::kLegacy, lidar::OusterProfile::kSingle,
                               lidar::OusterProfile::kLowRate, lidar::OusterProfile::kDual};

lidar::OusterMetadata Metadata(lidar::OusterProfile profile) {
  lidar::OusterMetadata metadata;
  metadata.beams.beams = kBeams;
  for (std::size_t i = 0; i < kBeams; ++i) metadata.beams.elevation_deg[i] = 15.0 - 2.0 * static_cast<double>(i);
  metadata.profile = profile;
  metadata.columns_per_turn = 1024;
  metadata.origin_to_beam_mm = 15.8;
  return metadata;
}

bool Run(lidar::OusterCodec* codec, const Bytes& payload) {
  static sensor::LidarPacket packet;
  const std::uint64_t before = codec->counters().packets + codec->counters().Rejected();
  const Status status = codec->Decode(payload, {1'000'000'000}, &packet);
  FUZZ_REQUIRE(codec->counters().packets + codec->counters().Rejected() == before + 1);
  FUZZ_REQUIRE(status == Status::kOk || packet.points.empty());
  FUZZ_REQUIRE(status != Status::kOk || (packet.azimuth_first_cdeg < 36000 && packet.azimuth_last_cdeg < 36000));
  for (const sensor::LidarPoint& point : packet.points) {
    FUZZ_REQUIRE(point.x * point.x + point.y * point.y + point.z * point.z < 1049.0F * 1049.0F);
    FUZZ_REQUIRE(point.ring < kBeams && point.dt_ns >= 0 && point.dt_ns <= lidar::Ouster::kMaxSpanNs);
  }
  return status == Status::kOk;
}

// Made once per profile, see velodyne_fuzz.cpp.
lidar::OusterCodec& FreshCodec(std::size_t profile, time::ClockMode mode) {
  static std::array codecs{lidar::OusterCodec(time::ClockMode::kShared), lidar::OusterCodec(time::ClockMode::kShared),
                           lidar::OusterCodec(time::ClockMode::kShared), lidar::OusterCodec(time::ClockMode::kShared)};
  static std::array<bool, kProfiles.size()> configured{};
  if (!configured[profile]) codecs[profile].Configure(Metadata(kProfiles[profile]));
  configured[profile] = true;
  time::SensorClockOptions options = time::kLidarHourClock;
  options.mode = mode;
  codecs[profile].clock() = time::SensorClock(options);
  return codecs[profile];
}

}  // namespace

std::vector<Bytes> Seeds() {
  std::vector<Bytes> out;
  for (std::size_t i = 0; i < kProfiles.size(); ++i) {
    lidar::test::OusterBuilder builder(kProfiles[i], kBeams);
    for (std::size_t k = 0; k < 16 * kBeams; k += 7) builder.Pixel(k / kBeams, k % kBeams, 8000 + k);
    Bytes bytes{static_cast<std::uint8_t>(i)};
    bytes.insert(bytes.end(), builder.bytes().begin(), builder.bytes().end());
    out.push_back(bytes);
  }
  return out;
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld;
  fuzz::Input input(data, size);
  const std::uint64_t selector = input.Number(1);
  const std::size_t which = selector % fuzz::kProfiles.size();
  const lidar::OusterProfile profile = fuzz::kProfiles[which];
  const time::ClockMode mode = size % 2 == 0 ? time::ClockMode::kShared : time::ClockMode::kReceive;
  fuzz::Bytes payload = input.Rest();
  if (fuzz::Run(&fuzz::FreshCodec(which, mode), payload)) return 0;
  lidar::test::OusterBuilder builder(profile, fuzz::kBeams);
  payload.resize(builder.bytes().size());
  builder.bytes() = payload;
  if (profile != lidar::OusterProfile::kLegacy) {
    builder.bytes()[0] = 1;
    builder.bytes()[1] = 0;
  }
  for (std::size_t i = 0; i < lidar::Ouster::kColumns; ++i) {
    builder.Column(i, 7'000'000'000 + 97'656 * i, i).Valid(i, i == 0 || (selector >> 2U) % (i + 1) != 1);
  }
  FUZZ_REQUIRE(fuzz::Run(&fuzz::FreshCodec(which, mode), builder.bytes()));
  return 0;
}
