// SPDX-License-Identifier: Apache-2.0
// The decoder on real captures. The sensors' metadata is not part of them, so angles are nominal; times, columns and
// ranges are the sensors' own.
#include <memory>

#include "drivers/lidar/ouster_codec.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/unit/drivers/lidar/ouster_packet.hpp"
#include "tests/unit/drivers/lidar/recordings.hpp"

namespace mapweld::lidar {
namespace {

struct CaptureCase {
  const char* file;
  const char* profile;
  std::size_t beams;
  std::size_t packets;
  std::size_t turns;
};

class OusterCapture : public testing::TestWithParam<CaptureCase> {};

TEST_P(OusterCapture, IsDecodedColumnByColumn) {
  const CaptureCase& c = GetParam();
  const auto file = mapweld::test::SharedData(c.file);
  if (!file) GTEST_SKIP() << c.file << " is not in the shared data folder";
  OusterMetadata metadata;
  ASSERT_EQ(ParseOusterMetadata(test::OusterJson(c.beams, c.profile), &metadata), Status::kOk);
  OusterCodec codec;
  codec.Configure(metadata);
  auto packet = std::make_unique<sensor::LidarPacket>();
  std::size_t turns = 0;
  std::size_t others = 0;
  TimeNs last;
  std::uint16_t last_azimuth = 36000;
  double sum_range_m = 0;
  for (const auto& [receive, payload] : test::PacketsOfCapture(*file)) {
    if (codec.Decode(payload, receive, packet.get()) != Status::kOk) {
      ++others;  // the inertial packets of the same capture
      continue;
    }
    if (packet->azimuth_first_cdeg < last_azimuth) ++turns;
    last_azimuth = packet->azimuth_first_cdeg;
    if (last.ns != 0) {
      EXPECT_NEAR(static_cast<double>((packet->t - last).ns), 16 * 100e6 / 1024, 50e3) << "16 of 1024 columns at 10 Hz";
    }
    last = packet->t;
    for (const sensor::LidarPoint& p : packet->points) sum_range_m += double{std::hypot(p.x, p.y, p.z)};
  }
  EXPECT_EQ(codec.counters().packets, c.packets);
  EXPECT_EQ(codec.counters().wrong_size, others);
  EXPECT_EQ(turns, c.turns);
  const double points = static_cast<double>(codec.counters().points);
  EXPECT_GT(points, 0.2 * static_cast<double>(c.packets * 16 * c.beams));
  EXPECT_GT(sum_range_m / points, 0.5);
  EXPECT_LT(sum_range_m / points, 60.0);
}

INSTANTIATE_TEST_SUITE_P(Captures, OusterCapture,
                         testing::Values(CaptureCase{"packets/ouster/OS-1-64_1024x10_fw20.pcap", "LEGACY", 64, 64, 1},
                                         CaptureCase{"packets/ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap",
                                                     "RNG15_RFL8_NIR8", 128, 192, 3}),
                         [](const auto& one) { return one.param.beams == 64 ? "Os1With64Beams" : "Os1With128Beams"; });

}  // namespace
}  // namespace mapweld::lidar
