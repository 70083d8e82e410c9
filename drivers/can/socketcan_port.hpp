// SPDX-License-Identifier: Apache-2.0
// A raw SocketCAN socket: kernel filter on the wanted identifiers, batches by recvmmsg, kernel receive stamps, losses
// in the socket's buffer counted exactly. The interface may go down and up again under it, and be unplugged and plugged
// in again. Owns 64 frames and their control buffers, about 13 KiB. No heap.
#pragma once

#include <linux/can.h>
#include <net/if.h>
#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/fixed_vector.hpp"
#include "drivers/can/can_port.hpp"
#include "drivers/time/receive_info.hpp"

namespace mapweld::can {

class SocketCanPort final : public CanPort {
 public:
  static constexpr std::size_t kBatch = 64;
  static constexpr std::size_t kMaxFilters = 32;
  static constexpr int kReceiveBufferBytes = 1 << 20;  // about 2 s of a saturated 1 Mbit/s bus

  struct Counters {
    std::uint64_t frames = 0;        // delivered, error frames included
    std::uint64_t error_frames = 0;  // of these
    std::uint64_t bus_off = 0;
    std::uint64_t restarted = 0;       // after bus-off
    std::uint64_t wrong_size = 0;      // not a classic CAN frame: dropped here
    std::uint64_t kernel_drops = 0;    // lost in the socket's buffer
    std::uint64_t interface_down = 0;  // times the kernel said so
    std::uint64_t unplugged = 0;       // times the interface ceased to exist
  };

  SocketCanPort() = default;
  ~SocketCanPort() { Close(); }

  // Opens `interface` ("can0") for these identifiers only, 29-bit ones with CAN_EFF_FLAG; none: everything. kIo with
  // errno when the kernel has no CAN, no such interface or refuses; kOutOfRange for a name that is too long or more
  // than kMaxFilters ids.
  Status Open(const char* interface, std::span<const std::uint32_t> wanted_ids);

  // After the interface ceased to exist: looks for one of the same name and goes on with it, by the same descriptor.
  // Costs next to nothing otherwise; call a few times per second, because a lost socket gives no more events. kOk:
  // there was nothing to do, or it is done; kNotReady: there is no such interface yet; kIo with errno.
  Status Reconnect();

  // Takes over an open descriptor whose datagrams are struct can_frame (a socketpair in tests). Made non-blocking.
  Status Adopt(int fd);

  void Close();

  Status Receive(std::span<CanFrame> out, std::size_t* n) override;
  [[nodiscard]] int fd() const override { return fd_; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  Status Bind();
  Status SetFilters();
  void CountErrorFrame(std::uint32_t error_class);

  int fd_ = -1;
  bool unplugged_ = false;
  std::array<char, IF_NAMESIZE> interface_{};
  FixedVector<std::uint32_t, kMaxFilters> wanted_ids_;
  bool gap_ = false;  // carried to the next delivered frame
  Counters counters_;
  time::DropCounter drops_;
  std::array<can_frame, kBatch> frames_{};
  std::array<iovec, kBatch> iov_{};
  std::array<mmsghdr, kBatch> headers_{};
  struct alignas(cmsghdr) Control {
    std::array<std::uint8_t, time::kControlBytes> bytes;
  };
  std::array<Control, kBatch> control_{};
};

}  // namespace mapweld::can
