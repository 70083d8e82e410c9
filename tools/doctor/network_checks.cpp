// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/network_checks.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

#include "drivers/bus/udpm_bus.hpp"
#include "drivers/lidar/udp_port.hpp"
#include "drivers/time/receive_info.hpp"

namespace mapweld::doctor {

std::string Device(const nlohmann::json& routes) {
  return routes.empty() ? "" : routes.front().value("dev", "");
}

std::string GroupText(const bus::UdpmAddress& address) {
  const std::uint32_t ip = address.group_ipv4;
  return fmt::format("{}.{}.{}.{}", ip >> 24U, ip >> 16U & 255U, ip >> 8U & 255U, ip & 255U);
}

Finding CheckRoute(const bus::UdpmAddress& address, const nlohmann::json& routes, const std::string& complaint,
                   const std::string& outward) {
  if (!Device(routes).empty()) {
    return {"LCM route", Verdict::kGood, fmt::format("{} by {}", GroupText(address), Device(routes)), ""};
  }
  // Without TTL the messages stay here, where the loopback interface is the right one.
  const std::string device = address.ttl == 0 ? "lo" : outward;
  return {"LCM route", Verdict::kFailure, fmt::format("none to {}: {}", GroupText(address), complaint),
          fmt::format("ip link set lo up; ip route add 224.0.0.0/4 dev {}", device)};
}

Finding CheckTtl(const bus::UdpmAddress& address, const nlohmann::json& routes, const std::string& outward) {
  if (address.ttl == 0) {
    return {"LCM TTL", Verdict::kWarning, "0: messages do not leave this machine; a host elsewhere hears nothing",
            fmt::format("export LCM_DEFAULT_URL='udpm://{}:{}?ttl=1'", GroupText(address), address.port)};
  }
  if (Device(routes) == "lo") {
    return {"LCM TTL", Verdict::kWarning,
            fmt::format("{}, but the route is by lo: messages do not leave this machine", address.ttl),
            fmt::format("ip route replace 224.0.0.0/4 dev {}", outward)};
  }
  return {"LCM TTL", Verdict::kGood, fmt::format("{}", address.ttl), ""};
}

Finding CheckLoopback(const bus::UdpmAddress& address) {
  const auto bus = std::make_unique<bus::UdpmBus>();
  const std::string url = fmt::format("udpm://{}:{}?ttl=0", GroupText(address), address.port);
  constexpr std::array<std::uint8_t, 8> kNothing{};
  constexpr std::string_view kChannel = "mapweld-doctor";
  bool heard = false;
  if (bus->Open(url, kChannel) == Status::kOk && bus->Publish(kChannel, kNothing) == Status::kOk) {
    const auto take = [](void* flag, std::string_view, std::span<const std::uint8_t>) {
      *static_cast<bool*>(flag) = true;
    };
    for (int i = 0; i < 100 && !heard; ++i) {
      pollfd waiting{.fd = bus->fd(), .events = POLLIN, .revents = 0};
      (void)::poll(&waiting, 1, 10);
      (void)bus->Receive({take, &heard});
    }
  }
  if (heard) return {"LCM multicast", Verdict::kGood, "a message to ourselves arrived", ""};
  return {"LCM multicast", Verdict::kFailure, "a message to ourselves did not arrive",
          "iptables -I INPUT -d 224.0.0.0/4 -j ACCEPT; ip link set lo up multicast on"};
}

Finding CheckReceiveBuffer(const std::string& whose, int wanted_bytes) {
  const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
  time::RequestReceiveBuffer(fd, wanted_bytes);
  int got = 0;
  socklen_t length = sizeof(got);
  (void)::getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &got, &length);
  ::close(fd);
  got /= 2;  // the kernel counts its own bookkeeping
  Finding finding{whose + " buffer", Verdict::kGood, fmt::format("{} bytes", got), ""};
  if (got >= wanted_bytes) return finding;
  finding.verdict = Verdict::kWarning;
  finding.what = fmt::format("{} of {} bytes: a burst is lost, and counted", got, wanted_bytes);
  finding.repair = fmt::format("sysctl -w net.core.rmem_max={}", wanted_bytes);
  return finding;
}

Finding CheckLidarPort(int port) {
  const auto udp = std::make_unique<lidar::UdpPort>();
  const Status status = udp->Open(static_cast<std::uint16_t>(port));
  if (status == Status::kOk) return {"LiDAR port", Verdict::kGood, fmt::format("UDP {} is free", port), ""};
  const bool taken = status == Status::kFull;
  return {"LiDAR port", taken ? Verdict::kWarning : Verdict::kFailure,
          fmt::format("UDP {}: {}", port, taken ? "taken; by an agent that runs?" : std::strerror(errno)),
          fmt::format("ss -lunp 'sport = :{}'", port)};
}

}  // namespace mapweld::doctor
