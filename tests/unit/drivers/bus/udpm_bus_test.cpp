// SPDX-License-Identifier: Apache-2.0
#include "drivers/bus/udpm_bus.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "tests/unit/drivers/bus/datagrams.hpp"
#include "tests/unit/drivers/bus/private_network.hpp"

namespace mapweld::bus {
namespace {

using test::Bytes;

struct Received {
  std::string channel;
  Bytes payload;
};

class UdpmBusTest : public testing::Test {
 protected:
  void SetUp() override {
    if (bus_->Open(test::PrivateUrl(), "MW.3.") != Status::kOk) {
      GTEST_SKIP() << "no multicast on this machine: " << std::strerror(errno);
    }
    UdpmAddress address;
    ASSERT_EQ(ParseLcmUrl(test::PrivateUrl(), &address), Status::kOk);
    raw_ = ::socket(AF_INET, SOCK_DGRAM, 0);
    group_.sin_family = AF_INET;
    group_.sin_addr.s_addr = htonl(address.group_ipv4);
    group_.sin_port = htons(address.port);
  }
  void TearDown() override {
    if (raw_ >= 0) ::close(raw_);
  }
  void SendRaw(const Bytes& datagram) const {
    ASSERT_EQ(
        ::sendto(raw_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&group_), sizeof(group_)),
        static_cast<ssize_t>(datagram.size()));
  }
  static void Store(void* context, std::string_view channel, std::span<const std::uint8_t> payload) {
    static_cast<std::vector<Received>*>(context)->push_back(
        {std::string(channel), Bytes(payload.begin(), payload.end())});
  }
  // Delivery on one machine happens within sendmsg; the wait is only for a busy one.
  std::vector<Received> Drain(std::size_t max_datagrams = UdpmBus::kDrain) {
    pollfd waiting{.fd = bus_->fd(), .events = POLLIN, .revents = 0};
    (void)::poll(&waiting, 1, 100);
    std::vector<Received> got;
    EXPECT_TRUE(bus_->Receive({.fn = Store, .context = &got}, max_datagrams).ok());
    return got;
  }

  std::unique_ptr<UdpmBus> bus_ = std::make_unique<UdpmBus>();
  int raw_ = -1;
  sockaddr_in group_{};
};

TEST_F(UdpmBusTest, HearsItself) {
  const Bytes payload = test::Pattern(1300);
  ASSERT_EQ(bus_->Publish("MW.3.POSE", payload), Status::kOk);
  const std::vector<Received> got = Drain();
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].channel, "MW.3.POSE");
  EXPECT_EQ(got[0].payload, payload);
  EXPECT_EQ(bus_->counters().sent, 1U);
  EXPECT_EQ(bus_->counters().sent_bytes, 1300U);
  EXPECT_EQ(bus_->counters().received_bytes, 1300U);
}

TEST_F(UdpmBusTest, IgnoresOtherChannels) {
  for (const char* channel : {"MW.30.POSE", "MW.3", "mw.3.POSE", "POSE"}) {
    ASSERT_EQ(bus_->Publish(channel, {}), Status::kOk);
  }
  EXPECT_TRUE(Drain().empty());
  EXPECT_EQ(bus_->counters().ignored, 4U);
}

TEST_F(UdpmBusTest, RefusesHostileDatagramsAndDeliversTheNextGoodMessage) {
  std::uint64_t sent = 0;
  for (const Bytes& hostile : test::HostileDatagrams()) {
    SendRaw(hostile);
    SendRaw(test::Short(1, "MW.3.COMMAND", test::Pattern(4)));
    const std::vector<Received> got = Drain();
    ASSERT_EQ(got.size(), 1U);
    ASSERT_EQ(got[0].payload, test::Pattern(4));
    ++sent;
    ASSERT_EQ(bus_->Rejected(), sent) << "every one is counted by its cause";
  }
}

TEST_F(UdpmBusTest, DeliversNothingFromARepeatedFragment) {
  SendRaw(
      test::Fragment({.sequence = 3, .size = 3000, .number = 0, .count = 3, .channel = "MW.3.X"}, test::Pattern(1000)));
  const Bytes second =
      test::Fragment({.sequence = 3, .size = 3000, .offset = 1000, .number = 1, .count = 3}, test::Pattern(1000));
  SendRaw(second);
  SendRaw(second);
  EXPECT_TRUE(Drain().empty());
  SendRaw(test::Fragment({.sequence = 3, .size = 3000, .offset = 2000, .number = 2, .count = 3}, test::Pattern(1000)));
  const std::vector<Received> got = Drain();
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].payload.size(), 3000U);
}

TEST_F(UdpmBusTest, SurvivesTwoHundredThousandChannelNames) {
  for (int i = 0; i < 200'000; ++i) {
    SendRaw(test::Short(0, "MW.3." + std::to_string(i), {}));
    if (i % 200 == 199) Drain(1000);
  }
  EXPECT_EQ(bus_->counters().received + bus_->counters().kernel_drops, 200'000U);
}

TEST_F(UdpmBusTest, StopsAtTheAskedNumberOfDatagrams) {
  for (int i = 0; i < 10; ++i) ASSERT_EQ(bus_->Publish("MW.3.POSE", {}), Status::kOk);
  EXPECT_EQ(Drain(4).size(), 4U);
  EXPECT_EQ(Drain(100).size(), 6U);
}

TEST_F(UdpmBusTest, RefusesToPublishWhatDoesNotFitOneDatagram) {
  EXPECT_EQ(bus_->Publish("", {}), Status::kOutOfRange);
  EXPECT_EQ(bus_->Publish(std::string(64, 'x'), {}), Status::kOutOfRange);
  EXPECT_EQ(bus_->Publish("MW.3.POSE", Bytes(65507)), Status::kOutOfRange);
  EXPECT_EQ(bus_->Publish("MW.3.POSE", Bytes(65499 - 10)), Status::kOk) << "the largest short message";
  EXPECT_EQ(bus_->counters().sent, 1U);
}

TEST_F(UdpmBusTest, CountsExactlyWhatTheKernelDropped) {
  const int on = 1;
  if (::setsockopt(bus_->fd(), SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof(on)) != 0) {
    GTEST_SKIP() << "this system does not count what it drops (an emulator?)";
  }
  const int small = 2304;
  ASSERT_EQ(::setsockopt(bus_->fd(), SOL_SOCKET, SO_RCVBUF, &small, sizeof(small)), 0);
  constexpr std::uint64_t kSent = 100;
  for (std::uint64_t i = 0; i < kSent; ++i) ASSERT_EQ(bus_->Publish("MW.3.POSE", Bytes(1000)), Status::kOk);
  Drain();
  ASSERT_EQ(bus_->Publish("MW.3.POSE", {}), Status::kOk);
  Drain();
  EXPECT_GT(bus_->counters().kernel_drops, 0U);
  EXPECT_EQ(bus_->counters().received + bus_->counters().kernel_drops, kSent + 1);
}

TEST(UdpmBus, SaysWhyItCannotOpen) {
  auto bus = std::make_unique<UdpmBus>();
  EXPECT_EQ(bus->Open("tcpq://localhost"), Status::kBadInput);
  EXPECT_EQ(bus->Open("udpm://", std::string(64, 'x')), Status::kOutOfRange);
  EXPECT_EQ(bus->fd(), -1);
  EXPECT_EQ(bus->Receive({}).status(), Status::kIo);
}

}  // namespace
}  // namespace mapweld::bus
