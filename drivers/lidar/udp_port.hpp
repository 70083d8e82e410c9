// SPDX-License-Identifier: Apache-2.0
// Receives datagrams on one UDP port, in batches, with the kernel's receive stamps and its count of losses.
// Owns 16 datagrams of at most 32 KiB, 0.5 MiB. No heap.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"
#include "core/base/time.hpp"
#include "drivers/time/receive_info.hpp"

namespace mapweld::lidar {

// A view into the port's buffers, valid until the next Receive.
struct Datagram {
  TimeNs receive;  // monotonic
  std::uint32_t source_ipv4 = 0;
  std::span<const std::uint8_t> payload;
};

class UdpPort {
 public:
  static constexpr std::size_t kBatch = 16;
  // Longer datagrams are dropped and counted; the longest of a sensor are just as long (128 beams, two returns).
  static constexpr std::size_t kMaxPayloadBytes = 33'024;
  static constexpr int kReceiveBufferBytes = 4 << 20;  // about 2 s of a VLP-16 in dual return mode

  struct Counters {
    std::uint64_t datagrams = 0;  // delivered
    std::uint64_t bytes = 0;
    std::uint64_t too_long = 0;      // dropped here
    std::uint64_t kernel_drops = 0;  // lost in the socket's buffer
  };

  UdpPort() = default;
  ~UdpPort() { Close(); }
  UdpPort(const UdpPort&) = delete;
  UdpPort& operator=(const UdpPort&) = delete;

  // Binds to every address. Port 0 takes a free one, see port(). kFull when another program has the port; kIo with
  // errno otherwise.
  Status Open(std::uint16_t port);
  void Close();

  // What is there, without waiting; an empty span when nothing is. kIo with errno otherwise.
  Status Receive(std::span<const Datagram>* out);

  [[nodiscard]] int fd() const { return fd_; }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  Status Bind(std::uint16_t port);

  int fd_ = -1;
  std::uint16_t port_ = 0;
  Counters counters_;
  time::DropCounter drops_;
  struct alignas(cmsghdr) Control {
    std::array<std::uint8_t, time::kControlBytes> bytes;
  };
  std::array<std::array<std::uint8_t, kMaxPayloadBytes>, kBatch> buffers_{};
  std::array<Control, kBatch> control_{};
  std::array<sockaddr_in, kBatch> sources_{};
  std::array<iovec, kBatch> iov_{};
  std::array<mmsghdr, kBatch> headers_{};
  std::array<Datagram, kBatch> datagrams_{};
};

}  // namespace mapweld::lidar
