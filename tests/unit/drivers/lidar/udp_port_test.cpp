// SPDX-License-Identifier: Apache-2.0
#include "drivers/lidar/udp_port.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>
#include <vector>

namespace mapweld::lidar {
namespace {

class UdpPortTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(port_->Open(0), Status::kOk);
    sender_ = ::socket(AF_INET, SOCK_DGRAM, 0);
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address_.sin_port = htons(port_->port());
  }
  void TearDown() override { ::close(sender_); }
  void Send(std::size_t bytes, std::uint8_t value = 0) {
    const std::vector<std::uint8_t> payload(bytes, value);
    ASSERT_EQ(
        ::sendto(sender_, payload.data(), bytes, 0, reinterpret_cast<const sockaddr*>(&address_), sizeof(address_)),
        static_cast<ssize_t>(bytes));
  }

  std::unique_ptr<UdpPort> port_ = std::make_unique<UdpPort>();
  int sender_ = -1;
  sockaddr_in address_{};
  std::span<const Datagram> got_;
};

TEST_F(UdpPortTest, GivesDatagramsWithTheirSizeSourceAndTime) {
  ASSERT_EQ(port_->Receive(&got_), Status::kOk);
  EXPECT_TRUE(got_.empty());
  Send(1206, 7);
  Send(512, 8);
  Send(0);
  ASSERT_EQ(port_->Receive(&got_), Status::kOk);
  ASSERT_EQ(got_.size(), 3U);
  EXPECT_EQ(got_[0].payload.size(), 1206U);
  EXPECT_EQ(got_[0].payload[1205], 7);
  EXPECT_EQ(got_[1].payload.size(), 512U);
  EXPECT_EQ(got_[2].payload.size(), 0U);
  EXPECT_EQ(got_[0].source_ipv4, INADDR_LOOPBACK);
  EXPECT_GT(got_[0].receive.ns, 0);
  EXPECT_LE(got_[0].receive, got_[2].receive);
}

TEST_F(UdpPortTest, DropsDatagramsThatAreTooLong) {
  Send(UdpPort::kMaxPayloadBytes);
  Send(UdpPort::kMaxPayloadBytes + 1);
  Send(60000);
  ASSERT_EQ(port_->Receive(&got_), Status::kOk);
  EXPECT_EQ(got_.size(), 1U);
  EXPECT_EQ(port_->counters().too_long, 2U);
}

TEST_F(UdpPortTest, EmptiesALargeBacklogInBatches) {
  for (int i = 0; i < 100; ++i) Send(100, static_cast<std::uint8_t>(i));
  std::uint8_t next = 0;
  for (;;) {
    ASSERT_EQ(port_->Receive(&got_), Status::kOk);
    if (got_.empty()) break;
    ASSERT_LE(got_.size(), UdpPort::kBatch);
    for (const Datagram& datagram : got_) ASSERT_EQ(datagram.payload[0], next++);
  }
  EXPECT_EQ(next, 100);
  EXPECT_EQ(port_->counters().datagrams, 100U);
  EXPECT_EQ(port_->counters().bytes, 10'000U);
}

TEST_F(UdpPortTest, CountsExactlyWhatTheKernelDropped) {
  const int on = 1;
  if (::setsockopt(port_->fd(), SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof(on)) != 0) {
    GTEST_SKIP() << "this system does not count what it drops (an emulator?)";
  }
  const int small = 2304;
  ASSERT_EQ(::setsockopt(port_->fd(), SOL_SOCKET, SO_RCVBUF, &small, sizeof(small)), 0);
  constexpr std::uint64_t kSent = 200;
  for (std::uint64_t i = 0; i < kSent; ++i) Send(1206);
  std::uint64_t delivered = 0;
  do {
    ASSERT_EQ(port_->Receive(&got_), Status::kOk);
    delivered += got_.size();
  } while (!got_.empty());
  // The kernel reports its losses with the next datagram that does get in.
  Send(1206);
  ASSERT_EQ(port_->Receive(&got_), Status::kOk);
  delivered += got_.size();
  EXPECT_LT(delivered, kSent);
  EXPECT_EQ(delivered + port_->counters().kernel_drops, kSent + 1);
}

TEST_F(UdpPortTest, SaysThatThePortIsInUse) {
  auto second = std::make_unique<UdpPort>();
  EXPECT_EQ(second->Open(port_->port()), Status::kFull);
  EXPECT_EQ(second->fd(), -1);
  EXPECT_EQ(second->Receive(&got_), Status::kIo);
  port_->Close();
  EXPECT_EQ(second->Open(ntohs(address_.sin_port)), Status::kOk);
}

}  // namespace
}  // namespace mapweld::lidar
