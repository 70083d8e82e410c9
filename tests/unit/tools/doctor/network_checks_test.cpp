// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/network_checks.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "drivers/lidar/udp_port.hpp"
#include "tools/doctor/ip_command.hpp"

namespace mapweld::doctor {
namespace {

const auto kByEth = nlohmann::json::parse(R"([{"type":"multicast","dst":"239.255.76.67","dev":"eth0"}])");
const auto kByLo = nlohmann::json::parse(R"([{"type":"multicast","dst":"239.255.76.67","dev":"lo"}])");
const auto kNone = nlohmann::json::array();

bus::UdpmAddress Address(std::uint8_t ttl) {
  bus::UdpmAddress address;
  address.ttl = ttl;
  return address;
}

TEST(RouteCheck, RepairsAMissingRouteByTheInterfaceThatTheTtlNeeds) {
  EXPECT_EQ(CheckRoute(Address(1), kByEth, "", "wlan0").verdict, Verdict::kGood);
  const Finding here = CheckRoute(Address(0), kNone, "RTNETLINK answers: Network is unreachable", "wlan0");
  EXPECT_EQ(here.verdict, Verdict::kFailure);
  EXPECT_EQ(here.repair, "ip link set lo up; ip route add 224.0.0.0/4 dev lo");
  EXPECT_EQ(CheckRoute(Address(1), kNone, "", "wlan0").repair, "ip link set lo up; ip route add 224.0.0.0/4 dev wlan0");
}

TEST(TtlCheck, WarnsWhenMessagesStayOnTheMachine) {
  EXPECT_EQ(CheckTtl(Address(1), kByEth, "wlan0").verdict, Verdict::kGood);
  EXPECT_EQ(CheckTtl(Address(0), kByEth, "wlan0").verdict, Verdict::kWarning);
  const Finding by_lo = CheckTtl(Address(1), kByLo, "wlan0");
  EXPECT_EQ(by_lo.verdict, Verdict::kWarning);
  EXPECT_EQ(by_lo.repair, "ip route replace 224.0.0.0/4 dev wlan0");
}

TEST(ReceiveBufferCheck, AsksTheKernel) {
  EXPECT_EQ(CheckReceiveBuffer("LCM", 4096).verdict, Verdict::kGood);
  const Finding finding = CheckReceiveBuffer("LCM", 1 << 30);  // more than any kernel gives
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_EQ(finding.repair, "sysctl -w net.core.rmem_max=1073741824");
}

TEST(LidarPortCheck, SeesThatAnotherProgramHasIt) {
  const auto port = std::make_unique<lidar::UdpPort>();
  ASSERT_EQ(port->Open(0), Status::kOk);
  EXPECT_EQ(CheckLidarPort(port->port()).verdict, Verdict::kWarning);
  const std::uint16_t number = port->port();
  port->Close();
  EXPECT_EQ(CheckLidarPort(number).verdict, Verdict::kGood);
}

TEST(IpCommand, GivesWhatItSaysOrWhyNot) {
  std::string complaint;
  EXPECT_EQ(RunIp({"link", "show", "dev", "lo"}, &complaint).at(0).at("ifname"), "lo");
  EXPECT_TRUE(RunIp({"link", "show", "dev", "no-such-thing"}, &complaint).empty());
  EXPECT_NE(complaint, "");
}

}  // namespace
}  // namespace mapweld::doctor
