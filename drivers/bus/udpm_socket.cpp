// SPDX-License-Identifier: Apache-2.0
#include "drivers/bus/udpm_socket.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include "drivers/time/receive_info.hpp"

namespace mapweld::bus {
namespace {

template <class T>
bool SetOption(int fd, int level, int name, const T& value) {
  return ::setsockopt(fd, level, name, &value, sizeof(value)) == 0;
}

bool Join(int fd, const UdpmAddress& address) {
  const int on = 1;
  const int off = 0;
  if (!SetOption(fd, SOL_SOCKET, SO_REUSEADDR, on)) return false;
  time::RequestReceiveBuffer(fd, static_cast<int>(address.receive_buffer_bytes));
  time::EnableReceiveInfo(fd);
  // Without this the kernel also hands over groups that other programs on this machine joined on the same port.
  (void)SetOption(fd, IPPROTO_IP, IP_MULTICAST_ALL, off);
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_port = htons(address.port);
  any.sin_addr.s_addr = htonl(INADDR_ANY);
  ip_mreq membership{};
  membership.imr_multiaddr.s_addr = htonl(address.group_ipv4);
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  return ::bind(fd, reinterpret_cast<const sockaddr*>(&any), sizeof(any)) == 0 &&
         SetOption(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, membership);
}

}  // namespace

int OpenUdpmReceiver(const UdpmAddress& address) {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0 || Join(fd, address)) return fd;
  const int why = errno;
  (void)::close(fd);
  errno = why;
  return -1;
}

}  // namespace mapweld::bus
