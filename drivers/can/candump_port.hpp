// SPDX-License-Identifier: Apache-2.0
// Replays a `candump -L` log through a fixed buffer, by recorded time: the caller pulls frames up to the time that the
// other sensors have reached. Malformed lines are counted and skipped. Owns 16 KiB. No heap.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "drivers/can/can_port.hpp"

namespace mapweld::can {

class CandumpPort final : public CanPort {
 public:
  static constexpr std::size_t kBufferBytes = 16384;
  static constexpr std::size_t kMaxLineBytes = 256;  // longer lines are malformed
  static constexpr std::size_t kMaxInterfaceBytes = 16;

  struct Counters {
    std::uint64_t frames = 0;
    std::uint64_t malformed = 0;
    std::uint64_t can_fd = 0;           // CAN FD lines, skipped
    std::uint64_t other_interface = 0;  // skipped
  };

  CandumpPort() = default;
  ~CandumpPort() { Close(); }

  // `interface` empty: frames of every interface. kIo with errno; kOutOfRange for a name that is too long.
  Status Open(const char* path, std::string_view interface = {});
  // Takes over an open descriptor, from its present position.
  Status Adopt(int fd, std::string_view interface = {});
  void Close();

  // Frames recorded at or before t, in the order of the log, at most out.size(). kEmpty when the log is used up and
  // nothing was delivered.
  Status ReceiveUntil(TimeNs t, std::span<CanFrame> out, std::size_t* n);

  // Recorded time of the next frame; kEmpty at the end of the log.
  Status NextTime(TimeNs* t);

  Status Receive(std::span<CanFrame> out, std::size_t* n) override;
  [[nodiscard]] int fd() const override { return fd_; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  Status Peek();
  Status TakeLine(std::string_view* line);
  Status Refill();

  int fd_ = -1;
  bool end_ = false;
  bool skipping_ = false;  // inside a line that is too long
  bool has_next_ = false;
  CanFrame next_;
  std::size_t begin_ = 0;
  std::size_t size_ = 0;
  std::size_t interface_bytes_ = 0;
  std::array<char, kMaxInterfaceBytes> interface_{};
  std::array<char, kBufferBytes> buffer_{};
  Counters counters_;
};

}  // namespace mapweld::can
