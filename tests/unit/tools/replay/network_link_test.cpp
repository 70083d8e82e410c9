// SPDX-License-Identifier: Apache-2.0
#include "tools/replay/network_link.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <lcm/lcm-cpp.hpp>
#include <mapweldlcm/command_t.hpp>
#include <string>

#include "tests/unit/tools/sim/test_folder.hpp"

namespace mapweld::replay {
namespace {

// Of this process alone, so that tests may run side by side.
std::string OwnUrl() {
  return "udpm://239.255.76.67:" + std::to_string(20000 + ::getpid() % 20000) + "?ttl=0";
}

class Wires : public testing::Test {
 protected:
  void SetUp() override {
    if (!agent_.good()) GTEST_SKIP() << "no multicast on this machine";
    fd_ = socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    ASSERT_EQ(bind(fd_, reinterpret_cast<sockaddr*>(&address), size), 0);
    ASSERT_EQ(getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    options_.agent_id = 3;
    options_.lidar_port = ntohs(address.sin_port);
    options_.lcm_url = OwnUrl();
  }
  void TearDown() override {
    if (fd_ >= 0) close(fd_);
  }
  // Multicast that is refused silently looks like messages that never come.
  bool PublishUntilHeard(NetworkLink& link, const mapweldlcm::health_t& health) {
    for (int i = 0; i < 50 && !link.health(); ++i) {
      (void)agent_.publish("MW.3.HEALTH", &health);
      link.Wait(0.1);
    }
    return link.health().has_value();
  }
  lcm::LCM agent_{OwnUrl()};
  NetworkOptions options_;
  int fd_ = -1;
};

TEST_F(Wires, CarryDatagramsHealthAndCommands) {
  NetworkLink link(options_);
  const std::array<std::uint8_t, 4> datagram{1, 2, 3, 4};
  link.SendLidar(datagram);
  std::array<std::uint8_t, 16> received{};
  ASSERT_EQ(recv(fd_, received.data(), received.size(), 0), 4);
  EXPECT_EQ(received[3], 4);

  mapweldlcm::health_t health{};
  health.agent_id = 3;
  health.lidar_packets = 77;
  if (!PublishUntilHeard(link, health)) GTEST_SKIP() << "multicast does not come back on this machine";
  EXPECT_EQ(link.health()->lidar_packets, 77);

  mapweldlcm::command_t heard{};
  agent_.subscribeFunction(
      "MW\\.3\\.COMMAND",
      +[](const lcm::ReceiveBuffer*, const std::string&, const mapweldlcm::command_t* m, mapweldlcm::command_t* out) {
        *out = *m;
      },
      &heard);
  for (int i = 0; i < 50 && heard.command == 0; ++i) {
    link.SendEndDrive();
    (void)agent_.handleTimeout(100);
  }
  EXPECT_EQ(heard.agent_id, 3);
  EXPECT_EQ(heard.command, mapweldlcm::command_t::COMMAND_END_DRIVE);
}

TEST_F(Wires, IgnoreTheHealthOfOthers) {
  NetworkLink link(options_);
  mapweldlcm::health_t health{};
  health.agent_id = 33;
  for (const char* channel : {"MW.33.HEALTH", "MW.3.HEALTH", "MW.3.HEALTHY", "MWx3.HEALTH"}) {
    (void)agent_.publish(channel, &health);
  }
  for (int i = 0; i < 5; ++i) link.Wait(0.02);
  EXPECT_FALSE(link.health());
}

TEST_F(Wires, SayWhichPartCannotBeOpened) {
  NetworkOptions no_host = options_;
  no_host.host = "no host has this name";
  EXPECT_THAT(sim::MessageOf([&] { NetworkLink link(no_host); }), testing::HasSubstr("cannot find host"));
  NetworkOptions no_can = options_;
  no_can.can_interface = "nosuchcan7";
  EXPECT_THAT(sim::MessageOf([&] { NetworkLink link(no_can); }), testing::HasSubstr("CAN"));
}

}  // namespace
}  // namespace mapweld::replay
