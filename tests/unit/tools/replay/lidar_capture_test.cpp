// SPDX-License-Identifier: Apache-2.0
#include "tools/replay/lidar_capture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <vector>

#include "tests/unit/tools/sim/test_folder.hpp"
#include "tools/sim/pcap_writer.hpp"

namespace mapweld::replay {
namespace {

constexpr int kEthernet = 1;
constexpr int kRawIp = 12;
constexpr int kLinuxCooked = 113;

using Bytes = std::vector<std::uint8_t>;

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

const Bytes kAddresses(12, 0xEE);
const Bytes kIpv4Type{0x08, 0x00};
const Bytes kPayload{'v', 'l', 'p'};

Bytes Ip(Bytes fragment = {0x40, 0x00}, std::uint8_t protocol = 17) {
  return Bytes{0x45, 0, 0, 31, 0, 0} + fragment + Bytes{64, protocol, 0, 0, 192, 168, 1, 201, 255, 255, 255, 255};
}
Bytes Udp(std::uint8_t port_low = 0x40, std::uint8_t length = 11) {
  return Bytes{0x09, 0x40, 0x09, port_low, 0, length, 0, 0} + kPayload;
}
std::size_t PayloadBytes(const Bytes& frame, int link_type = kEthernet) {
  return UdpPayload(frame, link_type, kLidarPorts).size();
}

TEST(UdpPayload, IsFoundBehindEveryLinkHeader) {
  EXPECT_EQ(PayloadBytes(kAddresses + kIpv4Type + Ip() + Udp()), 3U);
  EXPECT_EQ(PayloadBytes(kAddresses + Bytes{0x81, 0x00, 0x00, 0x05} + kIpv4Type + Ip() + Udp()), 3U);
  EXPECT_EQ(PayloadBytes(Bytes(14, 0) + kIpv4Type + Ip() + Udp(), kLinuxCooked), 3U);
  EXPECT_EQ(PayloadBytes(Ip() + Udp(), kRawIp), 3U);
  Bytes options = Ip() + Bytes{1, 1, 1, 1};
  options[0] = 0x46;
  EXPECT_EQ(PayloadBytes(kAddresses + kIpv4Type + options + Udp()), 3U);
}

TEST(UdpPayload, LeavesOutEverythingElse) {
  EXPECT_EQ(PayloadBytes(kAddresses + kIpv4Type + Ip() + Udp(0x41)), 0U) << "another port";
  EXPECT_EQ(PayloadBytes(kAddresses + Bytes{0x86, 0xDD} + Ip() + Udp()), 0U) << "IPv6";
  EXPECT_EQ(PayloadBytes(kAddresses + kIpv4Type + Ip({0x40, 0x00}, 6) + Udp()), 0U) << "TCP";
  EXPECT_EQ(PayloadBytes(kAddresses + kIpv4Type + Ip({0x20, 0x00}) + Udp()), 0U) << "first fragment";
  EXPECT_EQ(PayloadBytes(kAddresses + kIpv4Type + Ip({0x00, 0x10}) + Udp()), 0U) << "later fragment";
  EXPECT_EQ(PayloadBytes(kAddresses + kIpv4Type + Ip() + Udp(0x40, 200)), 0U) << "longer than captured";
  EXPECT_EQ(PayloadBytes(kAddresses + kIpv4Type + Ip() + Udp(0x40, 7)), 0U) << "shorter than its header";
  const Bytes whole = kAddresses + kIpv4Type + Ip() + Udp();
  for (std::size_t n = 0; n < whole.size(); ++n) {
    EXPECT_EQ(PayloadBytes(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n))), 0U) << n;
  }
}

TEST(LidarCapture, ReadsWhatTheSimulatorWrites) {
  const sim::TestFolder folder;
  sim::PcapWriter pcap(folder / "a.pcap", kLidarPorts[0]);
  for (std::int64_t i = 0; i < 5; ++i) pcap.Write(601'000'000'123 + i, Bytes(1206, static_cast<std::uint8_t>(i)));
  pcap.Close();
  LidarCapture capture(folder / "a.pcap");
  LidarCapture::Datagram datagram;
  for (std::int64_t i = 0; i < 5; ++i) {
    ASSERT_TRUE(capture.Next(&datagram));
    EXPECT_EQ(datagram.stamp_ns, 601'000'000'123 + i);
    ASSERT_EQ(datagram.payload.size(), 1206U);
    EXPECT_EQ(datagram.payload[1205], i);
  }
  EXPECT_FALSE(capture.Next(&datagram));
  EXPECT_FALSE(capture.truncated());
}

TEST(LidarCapture, TakesDatagramsToThePortOfAnyLidarAndNoOthers) {
  const sim::TestFolder folder;
  const std::map<std::uint16_t, bool> wanted{{2368, true}, {7502, true}, {8308, false}};
  for (const auto& [port, taken] : wanted) {
    sim::PcapWriter pcap(folder / "a.pcap", port);
    pcap.Write(1, Bytes(12'544, 7));
    pcap.Close();
    LidarCapture capture(folder / "a.pcap");
    LidarCapture::Datagram datagram;
    EXPECT_EQ(capture.Next(&datagram), taken) << port;
  }
}

TEST(LidarCapture, EndsBeforeAPacketThatBreaksOff) {
  const sim::TestFolder folder;
  sim::PcapWriter pcap(folder / "a.pcap", kLidarPorts[0]);
  for (int i = 0; i < 2; ++i) pcap.Write(i, Bytes(1206, 7));
  pcap.Close();
  const std::string whole = sim::ReadText(folder / "a.pcap");
  sim::WriteText(folder / "cut.pcap", whole.substr(0, whole.size() - 100));
  LidarCapture capture(folder / "cut.pcap");
  LidarCapture::Datagram datagram;
  EXPECT_TRUE(capture.Next(&datagram));
  EXPECT_FALSE(capture.Next(&datagram));
  EXPECT_TRUE(capture.truncated());
}

TEST(LidarCapture, NamesAFileThatIsNoCapture) {
  const sim::TestFolder folder;
  sim::WriteText(folder / "text.pcap", "no capture at all, only text that is long enough");
  EXPECT_THAT(sim::MessageOf([&] { LidarCapture capture(folder / "text.pcap"); }), testing::HasSubstr("text.pcap"));
  EXPECT_THAT(sim::MessageOf([&] { LidarCapture capture(folder / "gone.pcap"); }), testing::HasSubstr("gone.pcap"));
}

TEST(LidarCapture, TakesOnlyTheDataPacketsOfARealSensor) {
  const char* from_environment = std::getenv("MAPWELD_SHARED_DATA");
  const std::filesystem::path data = from_environment != nullptr
                                         ? std::filesystem::path(from_environment)
                                         : std::filesystem::path(MAPWELD_SOURCE_DIR) / "../shared/data";
  const auto file = data / "packets/pcap/sample_velodyne_vlp16_gps.pcap";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here; set MAPWELD_SHARED_DATA";
  LidarCapture capture(file);
  LidarCapture::Datagram datagram;
  int packets = 0;
  std::int64_t before = 0;
  for (; capture.Next(&datagram); ++packets) {
    EXPECT_EQ(datagram.payload.size(), 1206U);
    EXPECT_GE(datagram.stamp_ns, before);
    before = datagram.stamp_ns;
  }
  EXPECT_EQ(packets, 293);  // beside 57 position packets to another port
}

}  // namespace
}  // namespace mapweld::replay
