// SPDX-License-Identifier: Apache-2.0
#include "drivers/time/receive_info.hpp"

#include <linux/net_tstamp.h>

#include <cstring>
#include <ctime>

namespace mapweld::time {

void EnableReceiveInfo(int fd) {
  const int on = 1;
  // Unlike SO_TIMESTAMPNS, which then gives the time of reading, this gives no stamp to a datagram that has none.
  const unsigned stamps = SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE;
  (void)::setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPING, &stamps, sizeof(stamps));
  (void)::setsockopt(fd, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof(on));
}

void RequestReceiveBuffer(int fd, int bytes) {
  if (::setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof(bytes)) == 0) return;
  (void)::setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
}

bool ToMonotonic(TimeNs stamp_realtime, const ClockPair& now, TimeNs* out) {
  if (stamp_realtime.ns <= 0) return false;
  const DurationNs age = now.realtime - stamp_realtime;
  if (age < DurationNs{0} || age > kOldestStamp) return false;
  *out = now.monotonic - age;
  return true;
}

ReceiveInfo ReadReceiveInfo(const msghdr& header, const ClockPair& now) {
  ReceiveInfo info;
  info.t = now.monotonic;
  // CMSG_NXTHDR takes a pointer to mutable; the header itself is not changed.
  msghdr copy = header;
  for (cmsghdr* c = CMSG_FIRSTHDR(&copy); c != nullptr; c = CMSG_NXTHDR(&copy, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SCM_TIMESTAMPING && c->cmsg_len >= CMSG_LEN(sizeof(timespec))) {
      timespec stamp{};  // the first of three is the kernel's own, zero when missing
      std::memcpy(&stamp, CMSG_DATA(c), sizeof(stamp));
      const TimeNs realtime{static_cast<std::int64_t>(stamp.tv_sec) * 1'000'000'000 +
                            static_cast<std::int64_t>(stamp.tv_nsec)};
      info.stamped = ToMonotonic(realtime, now, &info.t);
    } else if (c->cmsg_type == SO_RXQ_OVFL && c->cmsg_len >= CMSG_LEN(sizeof(std::uint32_t))) {
      std::memcpy(&info.drops, CMSG_DATA(c), sizeof(info.drops));
      info.has_drops = true;
    }
  }
  return info;
}

std::uint32_t DropCounter::Update(const ReceiveInfo& info) {
  if (!info.has_drops) return 0;
  const std::uint32_t lost = info.drops - last_;
  last_ = info.drops;
  total_ += lost;
  return lost;
}

}  // namespace mapweld::time
