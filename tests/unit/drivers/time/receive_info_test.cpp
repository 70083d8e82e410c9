// SPDX-License-Identifier: Apache-2.0
#include "drivers/time/receive_info.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <unistd.h>

#include <array>

namespace mapweld::time {
namespace {

constexpr ClockPair kNow{.monotonic = {500'000'000'000}, .realtime = {1'700'000'000'000'000'000}};

TEST(ReceiveStamp, BecomesAnAgeOnTheMonotonicClock) {
  TimeNs t;
  ASSERT_TRUE(ToMonotonic(kNow.realtime - Milliseconds(3), kNow, &t));
  EXPECT_EQ(t, kNow.monotonic - Milliseconds(3));
}

TEST(ReceiveStamp, IsNotBelievedWhenTheWallClockStepped) {
  TimeNs t{1};
  EXPECT_FALSE(ToMonotonic({0}, kNow, &t));
  EXPECT_FALSE(ToMonotonic({-5}, kNow, &t));
  EXPECT_FALSE(ToMonotonic(kNow.realtime + DurationNs{1}, kNow, &t));
  EXPECT_FALSE(ToMonotonic(kNow.realtime - Milliseconds(3'600'000), kNow, &t));
  EXPECT_EQ(t.ns, 1);
}

TEST(DropCounter, CountsAcrossTheWrapOfTheKernelsCounter) {
  DropCounter drops;
  ReceiveInfo info;
  info.drops = 10;
  EXPECT_EQ(drops.Update(info), 0U) << "not attached";
  info.has_drops = true;
  info.drops = 0xFFFFFFFEU;
  EXPECT_EQ(drops.Update(info), 0xFFFFFFFEU);
  info.drops = 3;
  EXPECT_EQ(drops.Update(info), 5U);
  EXPECT_EQ(drops.total(), 0x100000003ULL);
}

TEST(ReceiveInfo, ReadsTheKernelsStampOfADatagram) {
  const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
  ASSERT_GE(fd, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof(address);
  ASSERT_EQ(::bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  ASSERT_EQ(::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &length), 0);
  const int none = 0;
  if (::setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPING, &none, sizeof(none)) != 0) {
    ::close(fd);
    GTEST_SKIP() << "this system does not stamp datagrams (an emulator?)";
  }
  EnableReceiveInfo(fd);
  // Stamping is switched on by a deferred work item in the kernel: the first datagrams may lack it.
  ReceiveInfo info;
  TimeNs before;
  for (int i = 0; i < 1000 && !info.stamped; ++i) {
    before = MonotonicNow();
    ASSERT_EQ(::sendto(fd, "x", 1, 0, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 1);
    char byte = 0;
    alignas(cmsghdr) std::array<char, kControlBytes> control;
    iovec iov{&byte, 1};
    msghdr header{};
    header.msg_iov = &iov;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    ASSERT_EQ(::recvmsg(fd, &header, 0), 1);
    info = ReadReceiveInfo(header, ReadClocks());
  }
  EXPECT_TRUE(info.stamped);
  EXPECT_LE(info.t, MonotonicNow());
  // The two clocks are read one after the other, hence the millisecond.
  EXPECT_GE(info.t + Milliseconds(1), before);
  ::close(fd);
}

}  // namespace
}  // namespace mapweld::time
