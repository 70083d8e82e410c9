// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/candump_port.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include "drivers/can/candump_line.hpp"

namespace mapweld::can {

Status CandumpPort::Open(const char* path, std::string_view interface) {
  const int fd = ::open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return Status::kIo;
  const Status status = Adopt(fd, interface);
  if (status != Status::kOk) (void)::close(fd);
  return status;
}

Status CandumpPort::Adopt(int fd, std::string_view interface) {
  if (interface.size() > interface_.size()) return Status::kOutOfRange;
  Close();
  std::copy(interface.begin(), interface.end(), interface_.begin());
  interface_bytes_ = interface.size();
  fd_ = fd;
  return Status::kOk;
}

void CandumpPort::Close() {
  if (fd_ >= 0) (void)::close(fd_);
  fd_ = -1;
  end_ = skipping_ = has_next_ = false;
  begin_ = size_ = 0;
}

Status CandumpPort::Refill() {
  if (end_) return Status::kEmpty;
  std::memmove(buffer_.data(), buffer_.data() + begin_, size_);
  begin_ = 0;
  const ssize_t got = ::read(fd_, buffer_.data() + size_, buffer_.size() - size_);
  if (got < 0) return errno == EAGAIN || errno == EINTR ? Status::kNotReady : Status::kIo;
  if (got == 0) {
    end_ = true;
    return Status::kEmpty;
  }
  size_ += static_cast<std::size_t>(got);
  return Status::kOk;
}

// The next whole line without its newline. The last line of a log may lack one.
Status CandumpPort::TakeLine(std::string_view* line) {
  for (;;) {
    const std::string_view held(buffer_.data() + begin_, size_);
    const std::size_t newline = held.find('\n');
    const bool whole = newline != std::string_view::npos;
    const std::size_t length = whole ? newline : held.size();
    if (whole || (end_ && length > 0) || length > kMaxLineBytes) {
      const std::size_t taken = whole ? length + 1 : length;
      begin_ += taken;
      size_ -= taken;
      const bool too_long = skipping_ || length > kMaxLineBytes;
      if (too_long && !skipping_) ++counters_.malformed;
      skipping_ = too_long && !whole;
      if (too_long) continue;
      *line = held.substr(0, length);
      return Status::kOk;
    }
    const Status status = Refill();
    // At the end of the file one more turn hands out what is left.
    if (status == Status::kEmpty && size_ > 0) continue;
    if (status != Status::kOk) return status;
  }
}

Status CandumpPort::Peek() {
  while (!has_next_) {
    if (fd_ < 0) return Status::kIo;
    std::string_view line;
    if (const Status status = TakeLine(&line); status != Status::kOk) return status;
    if (line.empty()) continue;
    std::string_view interface;
    const Status status = ParseCandumpLine(line, &next_, &interface);
    if (status == Status::kVersion) {
      ++counters_.can_fd;
    } else if (status != Status::kOk) {
      ++counters_.malformed;
    } else if (interface_bytes_ > 0 && interface != std::string_view(interface_.data(), interface_bytes_)) {
      ++counters_.other_interface;
    } else {
      has_next_ = true;
    }
  }
  return Status::kOk;
}

Status CandumpPort::NextTime(TimeNs* t) {
  const Status status = Peek();
  if (status == Status::kOk) *t = next_.receive;
  return status;
}

Status CandumpPort::ReceiveUntil(TimeNs t, std::span<CanFrame> out, std::size_t* n) {
  *n = 0;
  while (*n < out.size()) {
    const Status status = Peek();
    if (status == Status::kNotReady) return Status::kOk;
    if (status != Status::kOk) return *n > 0 ? Status::kOk : status;
    if (next_.receive > t) return Status::kOk;
    out[(*n)++] = next_;
    has_next_ = false;
    ++counters_.frames;
  }
  return Status::kOk;
}

Status CandumpPort::Receive(std::span<CanFrame> out, std::size_t* n) {
  return ReceiveUntil({std::numeric_limits<std::int64_t>::max()}, out, n);
}

}  // namespace mapweld::can
