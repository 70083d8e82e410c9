// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/socketcan_port.hpp"

#include <gtest/gtest.h>
#include <linux/can/error.h>
#include <unistd.h>

#include <cerrno>
#include <memory>

#include "drivers/can/xsens_table.hpp"

namespace mapweld::can {
namespace {

// A socketpair carries struct can_frame as a CAN socket would, on kernels without CAN too.
class SocketCanPortTest : public testing::Test {
 protected:
  void SetUp() override {
    std::array<int, 2> ends{};
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends.data()), 0);
    bus_ = ends[0];
    ASSERT_EQ(port_->Adopt(ends[1]), Status::kOk);
  }
  void TearDown() override { ::close(bus_); }

  void Send(canid_t id, std::uint8_t dlc = 8, std::uint8_t first_byte = 0) const {
    can_frame frame{};
    frame.can_id = id;
    frame.can_dlc = dlc;
    frame.data[0] = first_byte;
    ASSERT_EQ(::send(bus_, &frame, sizeof(frame), 0), static_cast<ssize_t>(sizeof(frame)));
  }

  int bus_ = -1;
  std::unique_ptr<SocketCanPort> port_ = std::make_unique<SocketCanPort>();
  std::array<CanFrame, 100> out_{};
  std::size_t n_ = 0;
};

TEST_F(SocketCanPortTest, GivesFramesInOrderWithoutWaiting) {
  ASSERT_EQ(port_->Receive(out_, &n_), Status::kOk);
  EXPECT_EQ(n_, 0U);
  for (std::uint8_t i = 0; i < 10; ++i) Send(0x034, 6, i);
  ASSERT_EQ(port_->Receive(out_, &n_), Status::kOk);
  ASSERT_EQ(n_, 10U);
  for (std::uint8_t i = 0; i < 10; ++i) {
    EXPECT_EQ(out_[i].id, 0x034U);
    EXPECT_EQ(out_[i].dlc, 6);
    EXPECT_EQ(out_[i].data[0], i);
    EXPECT_FALSE(out_[i].gap);
    EXPECT_GT(out_[i].receive.ns, 0);
  }
}

TEST_F(SocketCanPortTest, TellsTheKindsOfFrameApart) {
  Send(0x123 | CAN_EFF_FLAG);
  Send(0x123 | CAN_RTR_FLAG);
  Send(CAN_ERR_FLAG | CAN_ERR_PROT);
  Send(0x7FF, 200);
  ASSERT_EQ(port_->Receive(out_, &n_), Status::kOk);
  ASSERT_EQ(n_, 4U);
  EXPECT_TRUE(out_[0].extended);
  EXPECT_TRUE(out_[1].remote);
  EXPECT_TRUE(out_[2].error);
  EXPECT_EQ(out_[3].dlc, 8) << "a length beyond 8 is cut";
}

TEST_F(SocketCanPortTest, MarksTheFrameAfterBusOff) {
  Send(0x005);
  Send(CAN_ERR_FLAG | CAN_ERR_BUSOFF);
  Send(CAN_ERR_FLAG | CAN_ERR_RESTARTED);
  Send(0x006);
  Send(0x011);
  ASSERT_EQ(port_->Receive(out_, &n_), Status::kOk);
  ASSERT_EQ(n_, 5U);
  EXPECT_FALSE(out_[0].gap);
  EXPECT_TRUE(out_[3].gap);
  EXPECT_FALSE(out_[4].gap);
  EXPECT_EQ(port_->counters().bus_off, 1U);
  EXPECT_EQ(port_->counters().restarted, 1U);
  EXPECT_EQ(port_->counters().error_frames, 2U);
}

TEST_F(SocketCanPortTest, DropsWhatIsNotAClassicFrame) {
  const std::array<char, 72> flexible_data_rate{};
  ASSERT_EQ(::send(bus_, flexible_data_rate.data(), flexible_data_rate.size(), 0), 72);
  ASSERT_EQ(::send(bus_, flexible_data_rate.data(), 5, 0), 5);
  Send(0x005);
  ASSERT_EQ(port_->Receive(out_, &n_), Status::kOk);
  EXPECT_EQ(n_, 1U);
  EXPECT_EQ(port_->counters().wrong_size, 2U);
}

TEST_F(SocketCanPortTest, NeverGivesMoreThanAskedFor) {
  for (std::uint8_t i = 0; i < 20; ++i) Send(0x005, 4, i);
  ASSERT_EQ(port_->Receive(std::span(out_).first(7), &n_), Status::kOk);
  EXPECT_EQ(n_, 7U);
  ASSERT_EQ(port_->Receive(std::span(out_).first(50), &n_), Status::kOk);
  EXPECT_EQ(n_, 13U);
  EXPECT_EQ(out_[0].data[0], 7);
  EXPECT_EQ(port_->counters().frames, 20U);
}

TEST(SocketCanPort, SaysWhyItCannotOpen) {
  auto port = std::make_unique<SocketCanPort>();
  EXPECT_EQ(port->Open("a-name-that-is-too-long", kXsensWantedIds), Status::kOutOfRange);
  EXPECT_EQ(port->Open("nocan7", kXsensWantedIds), Status::kIo);
  EXPECT_NE(errno, 0);
  EXPECT_EQ(port->fd(), -1);
  std::array<CanFrame, 1> out;
  std::size_t n = 0;
  EXPECT_EQ(port->Receive(out, &n), Status::kIo);
}

}  // namespace
}  // namespace mapweld::can
