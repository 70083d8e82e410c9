// SPDX-License-Identifier: Apache-2.0
// The decoder against real packets: clouds that a vendor's decoder made of the same packets, and network captures.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "core/base/byte_io.hpp"
#include "drivers/lidar/velodyne_codec.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/unit/drivers/lidar/recordings.hpp"

namespace mapweld::lidar {
namespace {

using test::Payload;

constexpr double kDeg = std::numbers::pi / 180.0;

struct VendorCase {
  const VelodyneModel* model;
  const char* name;
  const char* bag;
  const char* cloud;
  std::size_t cloud_stride;
  std::size_t packets;
  std::uint64_t field_of_view_gaps;  // of a sensor that was told to look at part of the turn only
  double least_share;
};

class VelodyneRecording : public testing::TestWithParam<VendorCase> {};

// How far the sensor turned between blocks `block` and its successor, 0.01 degrees; as before at the packet's end.
int StepAfter(const Payload& payload, std::size_t block) {
  const std::size_t stride = payload[VelodynePacket::kModeAt] == VelodynePacket::kDual ? 2 : 1;
  const auto azimuth = [&](std::size_t i) {
    return int{ByteReader(std::span(payload).subspan(i * VelodynePacket::kBlockBytes + 2, 2)).Little<std::uint16_t>()};
  };
  std::size_t from = block - block % stride;
  if (from + stride >= VelodynePacket::kBlocks) from -= stride;
  return (azimuth(from + stride) - azimuth(from) + 36000) % 36000;
}

// Where in the packet each of our points comes from: block and place in it, in the order of the codec.
std::vector<std::pair<std::size_t, std::size_t>> Returns(const Payload& payload) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  const bool dual = payload[VelodynePacket::kModeAt] == VelodynePacket::kDual;
  const auto distance = [&](std::size_t block, std::size_t i) {
    const std::size_t at = block * VelodynePacket::kBlockBytes + 4 + 3 * i;
    return ByteReader(std::span(payload).subspan(at, 2)).Little<std::uint16_t>();
  };
  for (std::size_t block = 0; block < VelodynePacket::kBlocks; ++block) {
    for (std::size_t i = 0; i < VelodynePacket::kReturns; ++i) {
      const bool repeated = dual && block % 2 == 1 && distance(block, i) == distance(block - 1, i);
      if (distance(block, i) != 0 && !repeated) out.emplace_back(block, i);
    }
  }
  return out;
}

// The clouds were made by Autoware's driver (nebula). It reads distances and beams as we do, but places lasers
// elsewhere on the circle, by how far the sensor has turned when they fire. Its source, vlp16_decoder.cpp, says how:
// every block begins at the azimuth that was looked up as the successor of the block before it, and turns on to its own
// successor.
//   - The last block of a packet, in dual return mode the last two, has none and is not turned at all.
//   - In dual return mode the successor is two blocks on. A second return (odd block) so begins where the sensor will
//   be
//     after its firings, a step too far, and finds itself there again: no turn within the block.
//   - Azimuths are rounded to 0.01 degrees: 5 mm at 57 m.
//   - VLP-32C lasers fire in pairs; it turns them as if they fired one by one, twice as far.
// Our points are turned by exactly that difference before they are compared.
double VendorTurnsFurther(const VelodyneModel& model, const Payload& payload, std::size_t block, std::size_t i) {
  const bool dual = payload[VelodynePacket::kModeAt] == VelodynePacket::kDual;
  const double step = StepAfter(payload, block) * 0.01 * kDeg;
  const auto lasers = std::size_t{model.lasers};
  const auto part_of_block = [&](std::size_t lasers_at_once) {
    const double firing = static_cast<double>(model.firing_period_ps);
    const double laser = static_cast<double>(model.laser_period_ps) * static_cast<double>(i % lasers / lasers_at_once);
    const double block_ps = firing * static_cast<double>(VelodynePacket::kReturns / lasers);
    return (firing * static_cast<double>(i / lasers) + laser) / block_ps;
  };
  const double ours = step * part_of_block(model.lasers_at_once);
  if (block + (dual ? 2 : 1) >= VelodynePacket::kBlocks) return -ours;
  if (dual && block % 2 == 1) return step - ours;
  return step * part_of_block(1) - ours;
}

void AddAsTheVendorTurns(const VelodyneModel& model, const Payload& payload, std::span<const sensor::LidarPoint> points,
                         test::CloudIndex* index) {
  const auto returns = Returns(payload);
  ASSERT_EQ(returns.size(), points.size());
  for (std::size_t n = 0; n < points.size(); ++n) {
    const double more = VendorTurnsFurther(model, payload, returns[n].first, returns[n].second);
    const double x{points[n].x};
    const double y{points[n].y};  // azimuth runs clockwise
    index->Add(x * std::cos(more) + y * std::sin(more), y * std::cos(more) - x * std::sin(more), double{points[n].z});
  }
}

TEST_P(VelodyneRecording, AgreesWithTheVendorsCloud) {
  const VendorCase& c = GetParam();
  const auto bag = mapweld::test::SharedData(c.bag);
  const auto pcd = mapweld::test::SharedData(c.cloud);
  if (!bag || !pcd) GTEST_SKIP() << c.bag << " is not in the shared data folder";
  VelodyneCodec codec(*c.model);
  auto packet = std::make_unique<sensor::LidarPacket>();
  test::CloudIndex index;
  std::int64_t last_ns = -1;
  for (const Payload& payload : test::PacketsOfBag(*bag, VelodynePacket::kPayloadBytes, false)) {
    ASSERT_EQ(codec.Decode(payload, {}, packet.get()), Status::kOk);
    ASSERT_GT(packet->t.ns, last_ns);
    last_ns = packet->t.ns;
    ASSERT_NO_FATAL_FAILURE(AddAsTheVendorTurns(*c.model, payload, packet->points, &index));
  }
  EXPECT_EQ(codec.counters().packets, c.packets);
  EXPECT_EQ(codec.counters().odd_steps, c.field_of_view_gaps);
  const auto cloud = test::VendorCloud(*pcd, c.cloud_stride);
  double worst_m = 0;
  const double share = index.ShareWithin(0.005, cloud, &worst_m);
  std::printf("%s: %.3f %% of %zu points within 5 mm, worst %.4f m\n", c.name, 100 * share, cloud.size(), worst_m);
  EXPECT_GE(share, c.least_share);
  EXPECT_LT(worst_m, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Models, VelodyneRecording,
                         testing::Values(VendorCase{&kVlp16, "Vlp16", "packets/vlp16/1673400471837873222_0.db3",
                                                    "packets/vlp16/1673400472138016708.pcd", 32, 603, 0, 0.999},
                                         VendorCase{&kVlp32c, "Vlp32c", "packets/vlp32/1713492677464078412_0.db3",
                                                    "packets/vlp32/1713492677464078412.pcd", 12, 379, 5, 0.999}),
                         [](const auto& one) { return one.param.name; });

struct Capture {
  int data = 0;
  int other = 0;
  std::int64_t worst_step_ns = 0;  // between packets, off 12 blocks
};

Capture DecodeCapture(const std::filesystem::path& file, const VelodyneModel& model, VelodyneCodec* codec) {
  const auto packet_ns = static_cast<std::int64_t>(VelodynePacket::kBlocks * VelodynePacket::kReturns / model.lasers) *
                         model.firing_period_ps / 1000;
  Capture result;
  auto packet = std::make_unique<sensor::LidarPacket>();
  std::int64_t last_ns = 0;
  for (const auto& [receive, payload] : test::PacketsOfCapture(file)) {
    if (codec->Decode(payload, receive, packet.get()) != Status::kOk) {
      ++result.other;
      continue;
    }
    if (last_ns != 0)
      result.worst_step_ns = std::max(result.worst_step_ns, std::abs(packet->t.ns - last_ns - packet_ns));
    last_ns = packet->t.ns;
    ++result.data;
  }
  return result;
}

TEST(VelodyneCapture, TakesDataAndRefusesPositionPackets) {
  const auto file = mapweld::test::SharedData("packets/pcap/sample_velodyne_vlp16_gps.pcap");
  if (!file) GTEST_SKIP() << "packets/pcap is not in the shared data folder";
  VelodyneCodec codec(kVlp16);
  const Capture capture = DecodeCapture(*file, kVlp16, &codec);
  EXPECT_EQ(capture.data, 293);
  EXPECT_EQ(capture.other, 57);
  EXPECT_EQ(codec.counters().wrong_size, 57U);
  EXPECT_LT(capture.worst_step_ns, 10'000) << "packets follow each other every 24 firings";
}

TEST(VelodyneCapture, TakesEveryPacketOfAnHdl32e) {
  const auto file = mapweld::test::SharedData("packets/pcap/sample_velodyne_hdl32.pcap");
  if (!file) GTEST_SKIP() << "packets/pcap is not in the shared data folder";
  VelodyneCodec codec(kHdl32e);
  const Capture capture = DecodeCapture(*file, kHdl32e, &codec);
  EXPECT_EQ(capture.data, 500);
  EXPECT_EQ(codec.counters().odd_steps, 0U);
  EXPECT_GT(codec.counters().points, 100'000U);
  EXPECT_LT(capture.worst_step_ns, 10'000) << "packets follow each other every 12 firings";
}

TEST(VelodyneCapture, RefusesAnotherSensor) {
  const auto file = mapweld::test::SharedData("packets/pcap/sample_velodyne_hdl32.pcap");
  if (!file) GTEST_SKIP() << "packets/pcap is not in the shared data folder";
  VelodyneCodec codec(kVlp16);
  EXPECT_EQ(DecodeCapture(*file, kVlp16, &codec).data, 0);
  EXPECT_EQ(codec.counters().wrong_model, 500U);
}

}  // namespace
}  // namespace mapweld::lidar
