// SPDX-License-Identifier: Apache-2.0
// The port on a bus of the kernel. Needs an interface vcan0 and the right to switch it off and on: toolchain/vm/run has
// both.
#include <gtest/gtest.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "drivers/can/socketcan_port.hpp"
#include "drivers/can/xsens_table.hpp"

namespace mapweld::can {
namespace {

constexpr const char* kInterface = "vcan0";

class SocketCanBus : public testing::Test {
 protected:
  void SetUp() override {
    if (port_->Open(kInterface, kXsensWantedIds) != Status::kOk) {
      GTEST_SKIP() << "no CAN interface " << kInterface << " on this machine: " << std::strerror(errno);
    }
    sender_ = ::socket(PF_CAN, SOCK_RAW, CAN_RAW);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex(kInterface));
    ASSERT_EQ(::bind(sender_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  }
  void TearDown() override {
    if (sender_ >= 0) ::close(sender_);
  }
  void Send(canid_t id, std::uint8_t dlc = 6) const {
    can_frame frame{};
    frame.can_id = id;
    frame.can_dlc = dlc;
    ASSERT_EQ(::write(sender_, &frame, sizeof(frame)), static_cast<ssize_t>(sizeof(frame))) << std::strerror(errno);
  }
  void Receive() { ASSERT_EQ(port_->Receive(out_, &n_), Status::kOk) << std::strerror(errno); }
  // The sender, too, was told that the interface went down or away.
  void ForgetSendersError() const {
    int pending = 0;
    socklen_t length = sizeof(pending);
    ASSERT_EQ(::getsockopt(sender_, SOL_SOCKET, SO_ERROR, &pending, &length), 0);
  }
  static bool SwitchInterface(bool on) {
    ifreq request{};
    std::strncpy(request.ifr_name, kInterface, IFNAMSIZ - 1);
    const int fd = ::socket(PF_CAN, SOCK_RAW, CAN_RAW);
    bool done = ::ioctl(fd, SIOCGIFFLAGS, &request) == 0;
    const int flags = on ? request.ifr_flags | IFF_UP : request.ifr_flags & ~IFF_UP;
    request.ifr_flags = static_cast<short>(flags);
    done = done && ::ioctl(fd, SIOCSIFFLAGS, &request) == 0;
    ::close(fd);
    return done;
  }

  std::unique_ptr<SocketCanPort> port_ = std::make_unique<SocketCanPort>();
  int sender_ = -1;
  std::array<CanFrame, SocketCanPort::kBatch> out_{};
  std::size_t n_ = 0;
};

TEST_F(SocketCanBus, LetsOnlyTheWantedFramesIn) {
  for (std::uint32_t id = 0; id <= 0x7FF; ++id) {
    Send(id);
    Send(id | CAN_EFF_FLAG);
    Send(id | CAN_RTR_FLAG);
    Receive();
    const bool wanted = std::ranges::find(kXsensWantedIds, id) != kXsensWantedIds.end();
    ASSERT_EQ(n_, wanted ? 1U : 0U) << id;
    if (wanted) {
      ASSERT_EQ(out_[0].id, id);
      ASSERT_FALSE(out_[0].extended || out_[0].remote);
    }
  }
}

TEST_F(SocketCanBus, TellsExtendedIdentifiersFromShortOnes) {
  const std::array<std::uint32_t, 2> wanted{0x123 | CAN_EFF_FLAG, 0x18FF1234 | CAN_EFF_FLAG};
  ASSERT_EQ(port_->Open(kInterface, wanted), Status::kOk);
  for (const canid_t id : {0x123U, 0x123U | CAN_EFF_FLAG, 0x18FF1235U | CAN_EFF_FLAG, 0x18FF1234U | CAN_EFF_FLAG,
                           0x123U | CAN_EFF_FLAG | CAN_RTR_FLAG}) {
    Send(id);
  }
  Receive();
  ASSERT_EQ(n_, 2U);
  EXPECT_TRUE(out_[0].extended && out_[0].id == 0x123);
  EXPECT_TRUE(out_[1].extended && out_[1].id == 0x18FF1234);
}

TEST_F(SocketCanBus, StampsFramesBetweenWriteAndRead) {
  bool stamped = false;
  for (int i = 0; i < 1000 && !stamped; ++i) {  // the first frames may lack a stamp
    const TimeNs before = time::MonotonicNow();
    Send(0x034);
    Receive();
    ASSERT_EQ(n_, 1U);
    // The two clocks of the conversion are read one after the other, hence the allowance.
    ASSERT_LE(out_[0].receive, time::MonotonicNow());
    stamped = out_[0].stamped;
    if (stamped) {
      ASSERT_GE(out_[0].receive + Milliseconds(20), before);
    }
  }
  EXPECT_TRUE(stamped);
}

TEST_F(SocketCanBus, SeesErrorFramesAndMarksWhatFollows) {
  Send(CAN_ERR_FLAG | CAN_ERR_BUSOFF, 8);
  Send(0x034);
  Receive();
  ASSERT_EQ(n_, 2U);
  EXPECT_TRUE(out_[0].error);
  EXPECT_TRUE(out_[1].gap);
  EXPECT_EQ(port_->counters().bus_off, 1U);
}

TEST_F(SocketCanBus, CountsExactlyWhatItsBufferLost) {
  const int small = 2304;
  ASSERT_EQ(::setsockopt(port_->fd(), SOL_SOCKET, SO_RCVBUF, &small, sizeof(small)), 0);
  constexpr std::uint64_t kSent = 201;
  for (std::uint64_t i = 0; i < kSent; ++i) Send(0x034);
  std::uint64_t delivered = 0;
  do {
    Receive();
    delivered += n_;
  } while (n_ != 0);
  EXPECT_LT(delivered, kSent);
  EXPECT_EQ(port_->counters().kernel_drops, 0U) << "the kernel tells with the next frame";
  Send(0x034);
  Receive();
  ASSERT_EQ(n_, 1U);
  EXPECT_TRUE(out_[0].gap);
  EXPECT_EQ(delivered + port_->counters().kernel_drops, kSent);
}

TEST_F(SocketCanBus, GoesOnAfterTheInterfaceWasDown) {
  Send(0x034);
  Receive();
  ASSERT_EQ(n_, 1U);
  if (!SwitchInterface(false)) GTEST_SKIP() << "not allowed to switch " << kInterface << " off";
  pollfd waiting{.fd = port_->fd(), .events = POLLIN, .revents = 0};
  EXPECT_EQ(::poll(&waiting, 1, 1000), 1);
  EXPECT_EQ(port_->Receive(out_, &n_), Status::kNotReady);
  EXPECT_EQ(n_, 0U);
  ASSERT_TRUE(SwitchInterface(true));
  ForgetSendersError();
  Send(0x034);
  Receive();
  ASSERT_EQ(n_, 1U);
  EXPECT_TRUE(out_[0].gap);
  EXPECT_EQ(port_->counters().interface_down, 1U);
}

TEST_F(SocketCanBus, GoesOnWithTheSameFilterAfterTheAdapterWasReplugged) {
  const int index = static_cast<int>(::if_nametoindex(kInterface));
  if (std::system("ip link del vcan0") != 0) GTEST_SKIP() << "not allowed to remove " << kInterface;
  pollfd waiting{.fd = port_->fd(), .events = POLLIN, .revents = 0};
  EXPECT_EQ(::poll(&waiting, 1, 1000), 1);
  Status status = Status::kOk;
  for (int i = 0; i < 10 && port_->counters().unplugged == 0; ++i) status = port_->Receive(out_, &n_);
  EXPECT_EQ(status, Status::kNotReady);
  EXPECT_EQ(port_->Reconnect(), Status::kNotReady) << "not there yet";
  const int fd = port_->fd();
  // Another device in between, so that the interface gets another number.
  ASSERT_EQ(std::system("ip link add other0 type vcan; ip link add vcan0 type vcan; ip link set vcan0 up"), 0);
  ASSERT_NE(static_cast<int>(::if_nametoindex(kInterface)), index);
  ASSERT_EQ(port_->Reconnect(), Status::kOk);
  EXPECT_EQ(port_->fd(), fd) << "whoever polls it need not know";
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(kInterface));
  ASSERT_EQ(::bind(sender_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  ForgetSendersError();
  Send(0x100);
  Send(0x034);
  // The kernel hands a frame on after write() has returned, just after the new interface later than the next line here.
  waiting.revents = 0;
  EXPECT_EQ(::poll(&waiting, 1, 1000), 1);
  Receive();
  ASSERT_EQ(n_, 1U) << "the unwanted frame stays out";
  EXPECT_EQ(out_[0].id, 0x034U);
  EXPECT_TRUE(out_[0].gap);
  EXPECT_EQ(std::system("ip link del other0"), 0);
}

}  // namespace
}  // namespace mapweld::can
