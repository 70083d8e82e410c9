// SPDX-License-Identifier: Apache-2.0
#include "tools/replay/network_link.hpp"

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <mapweldlcm/command_t.hpp>
#include <stdexcept>
#include <thread>

namespace mapweld::replay {
namespace {

[[noreturn]] void Fail(const std::string& what, int error) {
  throw std::runtime_error(fmt::format("{}: {}", what, std::strerror(error)));
}

sockaddr_in Resolve(const std::string& host, std::uint16_t port) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (const int error = getaddrinfo(host.c_str(), nullptr, &wanted, &found); error != 0) {
    throw std::runtime_error(fmt::format("cannot find host {}: {}", host, gai_strerror(error)));
  }
  sockaddr_in address{};
  std::memcpy(&address, found->ai_addr, sizeof(address));
  freeaddrinfo(found);
  address.sin_port = htons(port);
  return address;
}

int OpenCan(const std::string& interface) {
  const int fd = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
  if (fd < 0) Fail("this kernel has no CAN sockets; load the modules can_raw and vcan", errno);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  int error = address.can_ifindex == 0 ? errno : 0;
  // It only sends: without this, what others send would fill its receive buffer.
  if (error == 0 && setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0) != 0) error = errno;
  if (error == 0 && bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) error = errno;
  if (error == 0) return fd;
  close(fd);
  Fail(fmt::format("cannot open CAN interface {}; for a virtual one: ip link add {} type vcan && ip link set {} up",
                   interface, interface, interface),
       error);
}

// Sends, waiting while the kernel's queue is full. `send_once` returns false with errno set when it fails.
template <typename SendOnce>
void SendPatiently(const char* what, SendOnce send_once) {
  constexpr int kMaxTries = 50'000;  // 10 s
  for (int i = 0; i < kMaxTries; ++i) {
    if (send_once()) return;
    if (errno != ENOBUFS && errno != EAGAIN && errno != EINTR) break;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  Fail(what, errno);
}

}  // namespace

NetworkLink::NetworkLink(const NetworkOptions& options)
    : options_(options), lcm_(options.lcm_url), to_(Resolve(options.host, options.lidar_port)) {
  if (!lcm_.good()) {
    throw std::runtime_error(
        fmt::format("cannot join the LCM network {}; a machine without a route for multicast needs 'ip route add "
                    "224.0.0.0/4 dev lo'",
                    options.lcm_url.empty() ? "of LCM_DEFAULT_URL" : options.lcm_url));
  }
  lcm::Subscription* subscription =
      lcm_.subscribe(fmt::format("MW\\.{}\\.HEALTH", options.agent_id), &NetworkLink::OnHealth, this);
  subscription->setQueueCapacity(0);  // by default LCM would keep the oldest 30
  udp_fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (udp_fd_ < 0) Fail("cannot open a UDP socket", errno);
  const int yes = 1;
  (void)setsockopt(udp_fd_, SOL_SOCKET, SO_BROADCAST, &yes, sizeof(yes));
  if (options.can_interface.empty()) return;
  try {
    can_fd_ = OpenCan(options.can_interface);
  } catch (...) {
    close(udp_fd_);
    throw;
  }
}

NetworkLink::~NetworkLink() {
  if (udp_fd_ >= 0) close(udp_fd_);
  if (can_fd_ >= 0) close(can_fd_);
}

void NetworkLink::SendLidar(std::span<const std::uint8_t> datagram) {
  SendPatiently("cannot send a LiDAR datagram", [&] {
    return sendto(udp_fd_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&to_), sizeof(to_)) >=
           0;
  });
}

void NetworkLink::SendCan(const can::CanFrame& frame) {
  if (can_fd_ < 0) return;
  can_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U);
  raw.can_dlc = frame.dlc;
  std::copy(frame.data.begin(), frame.data.end(), raw.data);
  SendPatiently("cannot send a CAN frame", [&] { return write(can_fd_, &raw, sizeof(raw)) == sizeof(raw); });
}

void NetworkLink::SendEndDrive() {
  mapweldlcm::command_t command{};
  command.agent_id = static_cast<std::int16_t>(options_.agent_id);
  command.command = mapweldlcm::command_t::COMMAND_END_DRIVE;
  if (lcm_.publish(fmt::format("MW.{}.COMMAND", options_.agent_id), &command) != 0) {
    throw std::runtime_error("cannot send a command over LCM; check the route for multicast");
  }
}

void NetworkLink::Wait(double max_s) {
  int timeout_ms = static_cast<int>(std::ceil(max_s * 1e3));
  while (lcm_.handleTimeout(timeout_ms) > 0) timeout_ms = 0;
}

void NetworkLink::SleepUntil(double time_s) {
  constexpr double kTakeMessages_s = 0.02;
  for (double left = time_s - Now_s(); left > 0; left = time_s - Now_s()) {
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, kTakeMessages_s)));
    if (left > kTakeMessages_s) Wait(0);
  }
  Wait(0);
}

double NetworkLink::Now_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void NetworkLink::OnHealth(const lcm::ReceiveBuffer*, const std::string&, const mapweldlcm::health_t* message) {
  if (message->agent_id == options_.agent_id) health_ = *message;
}

}  // namespace mapweld::replay
