// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/socketcan_port.hpp"

#include <fcntl.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace mapweld::can {
namespace {

CanFrame FromKernel(const can_frame& raw) {
  CanFrame frame;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.error = (raw.can_id & CAN_ERR_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended || frame.error ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.dlc = std::min<std::uint8_t>(raw.can_dlc, CAN_MAX_DLEN);
  std::memcpy(frame.data.data(), raw.data, frame.data.size());
  return frame;
}

}  // namespace

Status SocketCanPort::SetFilters() {
  const can_err_mask_t errors = CAN_ERR_MASK;
  if (::setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof(errors)) != 0) return Status::kIo;
  if (wanted_ids_.empty()) return Status::kOk;
  std::array<can_filter, kMaxFilters> filters{};
  for (std::size_t i = 0; i < wanted_ids_.size(); ++i) {
    // The flag bits in the mask keep remote frames, and frames of the other length of identifier, out.
    const canid_t bits = (wanted_ids_[i] & CAN_EFF_FLAG) != 0 ? CAN_EFF_MASK : CAN_SFF_MASK;
    filters[i] = {.can_id = wanted_ids_[i], .can_mask = bits | CAN_EFF_FLAG | CAN_RTR_FLAG};
  }
  const auto bytes = static_cast<socklen_t>(wanted_ids_.size() * sizeof(can_filter));
  return ::setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), bytes) == 0 ? Status::kOk : Status::kIo;
}

Status SocketCanPort::Bind() {
  sockaddr_can address{};
  address.can_family = AF_CAN;
  const unsigned index = ::if_nametoindex(interface_.data());
  if (index == 0) return Status::kIo;
  address.can_ifindex = static_cast<int>(index);
  return ::bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 ? Status::kOk : Status::kIo;
}

Status SocketCanPort::Open(const char* interface, std::span<const std::uint32_t> wanted_ids) {
  Close();
  if (std::strlen(interface) >= interface_.size() || wanted_ids.size() > kMaxFilters) return Status::kOutOfRange;
  interface_ = {};
  std::copy_n(interface, std::strlen(interface), interface_.begin());
  wanted_ids_.clear();
  for (const std::uint32_t id : wanted_ids) (void)wanted_ids_.TryPush(id);
  fd_ = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (fd_ < 0) return Status::kIo;
  // Filters before the bind, so that nothing else ever enters the buffer.
  Status status = SetFilters();
  if (status == Status::kOk) {
    time::RequestReceiveBuffer(fd_, kReceiveBufferBytes);
    time::EnableReceiveInfo(fd_);
    status = Bind();
  }
  if (status != Status::kOk) {
    const int why = errno;
    Close();
    errno = why;
  }
  return status;
}

Status SocketCanPort::Adopt(int fd) {
  Close();
  const int flags = ::fcntl(fd, F_GETFL);
  if (flags < 0 || ::fcntl(fd, F_SETFL, flags | O_NONBLOCK) != 0) return Status::kIo;
  fd_ = fd;
  time::EnableReceiveInfo(fd_);
  return Status::kOk;
}

void SocketCanPort::Close() {
  if (fd_ >= 0) (void)::close(fd_);
  fd_ = -1;
  unplugged_ = gap_ = false;
  drops_ = {};
}

Status SocketCanPort::Reconnect() {
  if (!unplugged_) return Status::kOk;
  // The kernel forgot the filters with the interface; without them everything on the bus would come in.
  if (const Status status = SetFilters(); status != Status::kOk) return status;
  if (Bind() != Status::kOk) return errno == ENODEV || errno == ENXIO ? Status::kNotReady : Status::kIo;
  unplugged_ = false;
  return Status::kOk;
}

void SocketCanPort::CountErrorFrame(std::uint32_t error_class) {
  ++counters_.error_frames;
  if ((error_class & CAN_ERR_BUSOFF) != 0) ++counters_.bus_off;
  if ((error_class & CAN_ERR_RESTARTED) != 0) ++counters_.restarted;
  // The controller lost frames or was off the bus: what follows does not continue what came before.
  if ((error_class & (CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_CRTL)) != 0) gap_ = true;
}

Status SocketCanPort::Receive(std::span<CanFrame> out, std::size_t* n) {
  *n = 0;
  if (fd_ < 0) return Status::kIo;
  const std::size_t batch = std::min(out.size(), kBatch);
  for (std::size_t i = 0; i < batch; ++i) {
    iov_[i] = {.iov_base = &frames_[i], .iov_len = sizeof(can_frame)};
    headers_[i] = {};
    headers_[i].msg_hdr.msg_iov = &iov_[i];
    headers_[i].msg_hdr.msg_iovlen = 1;
    headers_[i].msg_hdr.msg_control = control_[i].bytes.data();
    headers_[i].msg_hdr.msg_controllen = control_[i].bytes.size();
  }
  const int got = ::recvmmsg(fd_, headers_.data(), static_cast<unsigned>(batch), MSG_DONTWAIT, nullptr);
  if (got < 0) {
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return Status::kOk;
    gap_ = true;
    if (errno == ENODEV) {
      unplugged_ = true;
      ++counters_.unplugged;
      return Status::kNotReady;
    }
    if (errno != ENETDOWN) return Status::kIo;
    ++counters_.interface_down;
    return Status::kNotReady;
  }
  const time::ClockPair now = time::ReadClocks();
  for (std::size_t i = 0; i < static_cast<std::size_t>(got); ++i) {
    const time::ReceiveInfo info = time::ReadReceiveInfo(headers_[i].msg_hdr, now);
    if (drops_.Update(info) != 0) gap_ = true;
    if (headers_[i].msg_len != CAN_MTU || (headers_[i].msg_hdr.msg_flags & MSG_TRUNC) != 0) {
      ++counters_.wrong_size;
      continue;
    }
    CanFrame frame = FromKernel(frames_[i]);
    frame.receive = info.t;
    frame.stamped = info.stamped;
    if (frame.error) CountErrorFrame(frame.id);
    frame.gap = gap_;
    if (!frame.error) gap_ = false;
    out[(*n)++] = frame;
  }
  counters_.frames += *n;
  counters_.kernel_drops = drops_.total();
  return Status::kOk;
}

}  // namespace mapweld::can
