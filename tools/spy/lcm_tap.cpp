// SPDX-License-Identifier: Apache-2.0
#include "tools/spy/lcm_tap.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "drivers/bus/udpm_socket.hpp"

namespace mapweld::spy {

LcmTap::LcmTap(const std::string& lcm_url) {
  bus::UdpmAddress address;
  if (bus::ParseLcmUrl(lcm_url, &address) != Status::kOk) {
    throw std::runtime_error(
        fmt::format("'{}' is not an LCM network; it looks like udpm://239.255.76.67:7667?ttl=1", lcm_url));
  }
  fd_ = bus::OpenUdpmReceiver(address);
  if (fd_ < 0) {
    throw std::runtime_error(
        fmt::format("cannot join the LCM network {}: {}; 'mapweld doctor' tells why", lcm_url, std::strerror(errno)));
  }
}

LcmTap::~LcmTap() {
  ::close(fd_);
}

bool LcmTap::TakeOne(Traffic* traffic) {
  sockaddr_in from{};
  iovec iov{.iov_base = buffer_.data(), .iov_len = buffer_.size()};
  alignas(cmsghdr) std::uint8_t control[time::kControlBytes];
  msghdr header{};
  header.msg_name = &from;
  header.msg_namelen = sizeof(from);
  header.msg_iov = &iov;
  header.msg_iovlen = 1;
  header.msg_control = control;
  header.msg_controllen = sizeof(control);
  const ssize_t got = ::recvmsg(fd_, &header, MSG_DONTWAIT);
  if (got < 0) return false;
  const time::ReceiveInfo info = time::ReadReceiveInfo(header, time::ReadClocks());
  (void)drops_.Update(info);
  traffic->Take(info.t, {.ipv4 = ntohl(from.sin_addr.s_addr), .port = ntohs(from.sin_port)},
                std::span<const std::uint8_t>(buffer_).first(static_cast<std::size_t>(got)));
  return true;
}

void LcmTap::Listen(std::chrono::milliseconds wait, Traffic* traffic) {
  const auto end = std::chrono::steady_clock::now() + wait;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    if (left.count() <= 0) return;
    pollfd waiting{.fd = fd_, .events = POLLIN, .revents = 0};
    if (::poll(&waiting, 1, static_cast<int>(left.count())) <= 0) return;
    // A bounded number, so that a flood cannot hold us beyond the time.
    for (int i = 0; i < 1000 && TakeOne(traffic); ++i) {
    }
  }
}

}  // namespace mapweld::spy
