// SPDX-License-Identifier: Apache-2.0
// The decoder against real packets: the cloud that a vendor's decoder made of the same packets, and a network capture.
#include <gtest/gtest.h>
#include <pcap/pcap.h>
#include <sqlite3.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "drivers/lidar/vlp16_codec.hpp"
#include "tests/support/shared_data.hpp"

namespace mapweld::lidar {
namespace {

using Payload = std::vector<std::uint8_t>;

std::uint32_t ReadU32(const std::uint8_t* at) {
  std::uint32_t value = 0;
  std::memcpy(&value, at, sizeof(value));
  return value;
}

// The packets of every message of the bag. CDR: 4 bytes of encapsulation, then stamp, frame name, count and packets,
// each {seconds, nanoseconds, 1206 bytes}; integers are aligned to 4 bytes counted from after the encapsulation.
std::vector<Payload> PacketsOfBag(const std::filesystem::path& file) {
  std::vector<Payload> packets;
  sqlite3* database = nullptr;
  sqlite3_stmt* rows = nullptr;
  EXPECT_EQ(sqlite3_open_v2(file.c_str(), &database, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
  EXPECT_EQ(sqlite3_prepare_v2(database, "SELECT data FROM messages ORDER BY timestamp", -1, &rows, nullptr),
            SQLITE_OK);
  while (sqlite3_step(rows) == SQLITE_ROW) {
    const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(rows, 0)) + 4;
    const auto align = [](std::size_t at) { return (at + 3) / 4 * 4; };
    std::size_t at = align(12 + ReadU32(data + 8));
    const std::uint32_t count = ReadU32(data + at);
    at += 4;
    for (std::uint32_t i = 0; i < count; ++i) {
      at = align(at) + 8;
      packets.emplace_back(data + at, data + at + Vlp16::kPayloadBytes);
      at += Vlp16::kPayloadBytes;
    }
  }
  sqlite3_finalize(rows);
  sqlite3_close(database);
  return packets;
}

struct VendorPoint {
  float x, y, z;
  std::uint8_t intensity;
  std::uint16_t channel;
};

std::vector<VendorPoint> VendorCloud(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::string marker = "DATA binary\n";
  std::size_t at = text.find(marker) + marker.size();
  constexpr std::size_t kPointBytes = 12 + 1 + 1 + 2 + 4 * 4;
  std::vector<VendorPoint> cloud;
  for (; at + kPointBytes <= text.size(); at += kPointBytes) {
    VendorPoint point{};
    std::memcpy(&point.x, text.data() + at, 12);
    point.intensity = static_cast<std::uint8_t>(text[at + 12]);
    std::memcpy(&point.channel, text.data() + at + 14, 2);
    cloud.push_back(point);
  }
  return cloud;
}

TEST(Vlp16Recording, AgreesWithTheVendorsCloud) {
  const auto bag = test::SharedData("packets/vlp16/1673400471837873222_0.db3");
  const auto pcd = test::SharedData("packets/vlp16/1673400472138016708.pcd");
  if (!bag || !pcd) GTEST_SKIP() << "packets/vlp16 is not in the shared data folder";
  Vlp16Codec codec;
  auto packet = std::make_unique<sensor::LidarPacket>();
  std::vector<std::vector<sensor::LidarPoint>> by_ring(Vlp16::kLasers);
  std::int64_t last_ns = -1;
  for (const Payload& payload : PacketsOfBag(*bag)) {
    ASSERT_EQ(codec.Decode(payload, {}, packet.get()), Status::kOk);
    ASSERT_GT(packet->t.ns, last_ns);
    last_ns = packet->t.ns;
    for (const sensor::LidarPoint& point : packet->points) by_ring[point.ring].push_back(point);
  }
  EXPECT_EQ(codec.counters().packets, 603U);
  EXPECT_EQ(codec.counters().odd_steps, 0U);

  const std::vector<VendorPoint> cloud = VendorCloud(*pcd);
  ASSERT_EQ(cloud.size(), 14831U);
  // The vendor rounds azimuths to 0.01 degrees. In a packet's last firings, and for second returns without an equal
  // first one, it does not turn the lasers between blocks, so that its azimuth is up to one block's rotation, 0.4
  // degrees, off.
  constexpr float kDeg = std::numbers::pi_v<float> / 180.0F;
  std::size_t exact = 0;
  std::size_t within_a_block = 0;
  for (const VendorPoint& theirs : cloud) {
    ASSERT_LT(theirs.channel, Vlp16::kLasers);
    const float range_m = std::hypot(theirs.x, theirs.y, theirs.z);
    const auto matches = [&](const sensor::LidarPoint& ours, float azimuth_deg) {
      const float tolerance_m = 0.0005F + range_m * azimuth_deg * kDeg;
      return std::abs(ours.x - theirs.x) < tolerance_m && std::abs(ours.y - theirs.y) < tolerance_m &&
             std::abs(std::hypot(ours.x, ours.y, ours.z) - range_m) < 0.0005F &&
             std::abs(ours.z - theirs.z) < 0.0005F && ours.intensity == static_cast<float>(theirs.intensity);
    };
    const auto& ring = by_ring[theirs.channel];
    if (std::ranges::any_of(ring, [&](const auto& ours) { return matches(ours, 0.01F); })) {
      ++exact;
    } else if (std::ranges::any_of(ring, [&](const auto& ours) { return matches(ours, 0.42F); })) {
      ++within_a_block;
    }
  }
  EXPECT_EQ(exact + within_a_block, cloud.size()) << exact << " exact, " << within_a_block << " within a block";
  EXPECT_GT(exact, cloud.size() * 4 / 5);
  RecordProperty("exact", static_cast<int>(exact));
}

struct Capture {
  int data = 0;
  int other = 0;
};

Capture DecodeCapture(const std::filesystem::path& file, Vlp16Codec* codec, std::int64_t* worst_step_ns) {
  std::array<char, PCAP_ERRBUF_SIZE> error{};
  pcap_t* capture = pcap_open_offline(file.c_str(), error.data());
  EXPECT_NE(capture, nullptr) << error.data();
  Capture result;
  auto packet = std::make_unique<sensor::LidarPacket>();
  pcap_pkthdr* header = nullptr;
  const u_char* frame = nullptr;
  std::int64_t last_ns = 0;
  while (pcap_next_ex(capture, &header, &frame) == 1) {
    constexpr std::size_t kHeaders = 14 + 20 + 8;  // Ethernet, IPv4 without options, UDP
    const std::span<const std::uint8_t> payload(frame + kHeaders, header->caplen - kHeaders);
    const TimeNs receive{header->ts.tv_sec * 1'000'000'000LL + header->ts.tv_usec * 1000LL};
    if (codec->Decode(payload, receive, packet.get()) == Status::kOk) {
      if (last_ns != 0) *worst_step_ns = std::max(*worst_step_ns, std::abs(packet->t.ns - last_ns - 1'327'104));
      last_ns = packet->t.ns;
      ++result.data;
    } else {
      ++result.other;
    }
  }
  pcap_close(capture);
  return result;
}

TEST(Vlp16Recording, TakesDataAndRefusesPositionPacketsOfACapture) {
  const auto file = test::SharedData("packets/pcap/sample_velodyne_vlp16_gps.pcap");
  if (!file) GTEST_SKIP() << "packets/pcap is not in the shared data folder";
  Vlp16Codec codec;
  std::int64_t worst_step_ns = 0;
  const Capture capture = DecodeCapture(*file, &codec, &worst_step_ns);
  EXPECT_EQ(capture.data, 293);
  EXPECT_EQ(capture.other, 57);
  EXPECT_EQ(codec.counters().wrong_size, 57U);
  EXPECT_LT(worst_step_ns, 10'000) << "packets follow each other every 24 firings";
}

TEST(Vlp16Recording, RefusesAnotherSensorsCapture) {
  const auto file = test::SharedData("packets/pcap/sample_velodyne_hdl32.pcap");
  if (!file) GTEST_SKIP() << "packets/pcap is not in the shared data folder";
  Vlp16Codec codec;
  std::int64_t worst_step_ns = 0;
  const Capture capture = DecodeCapture(*file, &codec, &worst_step_ns);
  EXPECT_EQ(capture.data, 0);
  EXPECT_EQ(codec.counters().wrong_model, 500U);
}

}  // namespace
}  // namespace mapweld::lidar
