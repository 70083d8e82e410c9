// SPDX-License-Identifier: Apache-2.0
#include "drivers/lidar/udp_port.hpp"

#include <arpa/inet.h>
#include <unistd.h>

#include <cerrno>

namespace mapweld::lidar {

Status UdpPort::Bind(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  address.sin_port = htons(port);
  if (::bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    return errno == EADDRINUSE ? Status::kFull : Status::kIo;
  }
  socklen_t length = sizeof(address);
  if (::getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &length) != 0) return Status::kIo;
  port_ = ntohs(address.sin_port);
  return Status::kOk;
}

Status UdpPort::Open(std::uint16_t port) {
  Close();
  fd_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd_ < 0) return Status::kIo;
  time::RequestReceiveBuffer(fd_, kReceiveBufferBytes);
  time::EnableReceiveInfo(fd_);
  const Status status = Bind(port);
  if (status != Status::kOk) {
    const int why = errno;
    Close();
    errno = why;
  }
  return status;
}

void UdpPort::Close() {
  if (fd_ >= 0) (void)::close(fd_);
  fd_ = -1;
  port_ = 0;
  drops_ = {};
}

Status UdpPort::Receive(std::span<const Datagram>* out) {
  *out = {};
  if (fd_ < 0) return Status::kIo;
  for (std::size_t i = 0; i < kBatch; ++i) {
    iov_[i] = {.iov_base = buffers_[i].data(), .iov_len = buffers_[i].size()};
    headers_[i] = {};
    msghdr& header = headers_[i].msg_hdr;
    header.msg_name = &sources_[i];
    header.msg_namelen = sizeof(sockaddr_in);
    header.msg_iov = &iov_[i];
    header.msg_iovlen = 1;
    header.msg_control = control_[i].bytes.data();
    header.msg_controllen = control_[i].bytes.size();
  }
  const int got = ::recvmmsg(fd_, headers_.data(), kBatch, MSG_DONTWAIT, nullptr);
  if (got < 0) {
    return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR || errno == ENETDOWN ? Status::kOk : Status::kIo;
  }
  const time::ClockPair now = time::ReadClocks();
  std::size_t n = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(got); ++i) {
    const time::ReceiveInfo info = time::ReadReceiveInfo(headers_[i].msg_hdr, now);
    (void)drops_.Update(info);
    if ((headers_[i].msg_hdr.msg_flags & MSG_TRUNC) != 0) {
      ++counters_.too_long;
      continue;
    }
    datagrams_[n++] = {.receive = info.t,
                       .source_ipv4 = ntohl(sources_[i].sin_addr.s_addr),
                       .payload = std::span(buffers_[i]).first(headers_[i].msg_len)};
    counters_.bytes += headers_[i].msg_len;
  }
  counters_.datagrams += n;
  counters_.kernel_drops = drops_.total();
  *out = std::span<const Datagram>(datagrams_).first(n);
  return Status::kOk;
}

}  // namespace mapweld::lidar
