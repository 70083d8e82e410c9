// SPDX-License-Identifier: Apache-2.0
// The agent's own LCM transport over UDP multicast: works with every LCM program, without liblcm, because liblcm
// allocates while receiving. One thread only.
// Messages of this process come back too (multicast loop), as in LCM; the caller tells them apart by channel.
// Owns one datagram buffer of 64 KiB and the reassembly slots. No heap, no waiting.
#pragma once

#include <netinet/in.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/status.hpp"
#include "drivers/bus/lcm_url.hpp"
#include "drivers/bus/udpm_reassembly.hpp"
#include "drivers/bus/udpm_wire.hpp"
#include "drivers/time/receive_info.hpp"

namespace mapweld::bus {

// Called once per message; the views are valid during the call.
struct MessageSink {
  void (*fn)(void* context, std::string_view channel, std::span<const std::uint8_t> payload) = nullptr;
  void* context = nullptr;
};

class UdpmBus {
 public:
  static constexpr std::size_t kDrain = 256;  // datagrams per Receive, so that a flood cannot hold the caller

  struct Counters {
    std::uint64_t sent = 0;
    std::uint64_t sent_bytes = 0;   // payload, without LCM's header
    std::uint64_t send_failed = 0;  // refused by the kernel: no route, buffer full, interface down
    std::uint64_t received = 0;     // messages delivered to the sink
    std::uint64_t received_bytes = 0;
    std::uint64_t ignored = 0;    // well-formed, on channels of no interest
    std::uint64_t fragments = 0;  // well-formed fragments
    // refused datagrams
    std::uint64_t too_short = 0;
    std::uint64_t wrong_magic = 0;
    std::uint64_t wrong_channel = 0;
    std::uint64_t too_large = 0;
    std::uint64_t wrong_fragment = 0;
    std::uint64_t contradicting = 0;
    std::uint64_t kernel_drops = 0;  // lost in the socket's buffer
  };

  UdpmBus() = default;
  ~UdpmBus() { Close(); }
  UdpmBus(const UdpmBus&) = delete;
  UdpmBus& operator=(const UdpmBus&) = delete;

  // url: see ParseLcmUrl. Only channels that begin with `channel_prefix` reach the sink; empty: all do.
  // kBadInput for the url, kOutOfRange for the prefix; kIo with errno, ENETUNREACH or ENODEV when the machine has no
  // route for multicast.
  Status Open(std::string_view url, std::string_view channel_prefix = {});
  void Close();

  // One message, one datagram, one sendmsg. kOutOfRange for a channel or a payload that does not fit one datagram;
  // kFull when the socket's buffer is full, kIo with errno otherwise. Both count as send_failed, nothing is retried.
  Status Publish(std::string_view channel, std::span<const std::uint8_t> payload);

  // Hands what has arrived to `sink`, at most max_datagrams. Gives the number of datagrams taken from the socket; fewer
  // than the maximum means the socket is empty.
  Result<std::size_t> Receive(const MessageSink& sink, std::size_t max_datagrams = kDrain);

  [[nodiscard]] int fd() const { return receive_fd_; }
  [[nodiscard]] const Counters& counters() const { return counters_; }
  [[nodiscard]] std::uint64_t Rejected() const;

 private:
  Status OpenSender(const UdpmAddress& address);
  void Handle(std::span<const std::uint8_t> datagram, const Sender& sender, const MessageSink& sink);
  void Deliver(const BusMessage& message, const MessageSink& sink);
  void Count(Refusal refusal);

  int receive_fd_ = -1;
  int send_fd_ = -1;
  sockaddr_in group_{};
  std::uint32_t sequence_ = 0;
  std::size_t prefix_bytes_ = 0;
  std::array<char, kMaxChannelBytes> prefix_{};
  Counters counters_;
  time::DropCounter drops_;
  UdpmReassembly reassembly_;
  struct alignas(cmsghdr) Control {
    std::array<std::uint8_t, time::kControlBytes> bytes;
  };
  Control control_{};
  std::array<std::uint8_t, kMaxDatagramBytes> buffer_{};
};

}  // namespace mapweld::bus
