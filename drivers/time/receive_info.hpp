// SPDX-License-Identifier: Apache-2.0
// What the kernel tells about a received datagram or CAN frame: when it came and how many were lost before it.
// The kernel stamps with the wall clock; the stamp is used only for the age of the datagram, so that wall-clock steps,
// a zero stamp or a stamp from the future cannot reach the estimator: such a stamp falls back to the time of reading.
#pragma once

#include <sys/socket.h>

#include <cstddef>
#include <cstdint>

#include "core/base/time.hpp"
#include "drivers/time/monotonic_clock.hpp"

namespace mapweld::time {

// Room for the stamp and the drop counter, aligned as the kernel's macros expect.
inline constexpr std::size_t kControlBytes = 128;

struct ReceiveInfo {
  TimeNs t;                 // monotonic
  bool stamped = false;     // false: t is the time of reading, because the kernel's stamp was missing or implausible
  bool has_drops = false;   // the kernel attached its counter
  std::uint32_t drops = 0;  // frames lost in this socket's buffer since it was opened, modulo 2^32
};

// Older than this when read, a stamp is taken for a step of the wall clock.
inline constexpr DurationNs kOldestStamp = Milliseconds(2000);

// Asks for stamps (SO_TIMESTAMPING, software) and the drop counter (SO_RXQ_OVFL). Either may be refused (a socketpair,
// an emulator); the receiver then works without it.
void EnableReceiveInfo(int fd);

// A receive buffer of the wanted size: beyond the system's limit when permitted, else as large as the limit allows.
void RequestReceiveBuffer(int fd, int bytes);

// `header` as filled by recvmsg/recvmmsg; `now` read right after that call.
ReceiveInfo ReadReceiveInfo(const msghdr& header, const ClockPair& now);

// Moves a wall-clock stamp to the monotonic clock. false when it is implausible.
bool ToMonotonic(TimeNs stamp_realtime, const ClockPair& now, TimeNs* out);

// Turns the kernel's wrapping counter into losses since the last call.
class DropCounter {
 public:
  // Number lost right before the datagram that carried `info`.
  std::uint32_t Update(const ReceiveInfo& info);
  [[nodiscard]] std::uint64_t total() const { return total_; }

 private:
  std::uint32_t last_ = 0;
  std::uint64_t total_ = 0;
};

}  // namespace mapweld::time
