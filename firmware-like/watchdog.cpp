// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/watchdog.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace mapweld::executive {

Watchdog::~Watchdog() {
  if (fd_ >= 0) close(fd_);
}

void Watchdog::Open() {
  const char* const path = std::getenv("NOTIFY_SOCKET");
  sockaddr_un address{};
  if (path == nullptr || path[0] == '\0' || std::strlen(path) >= sizeof(address.sun_path)) return;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path, std::strlen(path));
  if (address.sun_path[0] == '@') address.sun_path[0] = '\0';  // abstract socket
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return;
  const auto bytes = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + std::strlen(path));
  if (connect(fd, reinterpret_cast<const sockaddr*>(&address), bytes) != 0) {
    close(fd);
    return;
  }
  fd_ = fd;
}

void Watchdog::Send(const char* text) const {
  if (fd_ >= 0) (void)send(fd_, text, std::strlen(text), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace mapweld::executive
