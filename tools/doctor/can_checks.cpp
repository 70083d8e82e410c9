// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/can_checks.hpp"

#include <fmt/format.h>
#include <linux/can.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace mapweld::doctor {
namespace {

constexpr double kBusyShare = 0.7;  // of a bus that others use too

// The least of the usual rates that the messages fill by less than kBusyShare.
std::int64_t BitrateFor(double load) {
  for (const std::int64_t rate : {125'000, 250'000, 500'000, 1'000'000}) {
    if (load <= kBusyShare * static_cast<double>(rate)) return rate;
  }
  return 1'000'000;
}

std::string SetUp(const std::string& interface, std::int64_t bitrate) {
  return fmt::format("ip link set {0} down; ip link set {0} up type can bitrate {1} restart-ms 100", interface,
                     bitrate);
}

Finding CheckState(const std::string& interface, const CanLink& link) {
  Finding finding{"CAN state", Verdict::kGood, fmt::format("{}, {} times bus-off", link.state, link.bus_off), ""};
  if (link.state == "ERROR-ACTIVE") return finding;
  if (link.state == "BUS-OFF" || link.state == "STOPPED") {
    finding.verdict = Verdict::kFailure;
    finding.repair = fmt::format("ip link set {0} down; ip link set {0} up", interface);
  } else {
    finding.verdict = Verdict::kWarning;
    finding.what += "; wiring, termination (120 ohms at both ends) or another bit rate on the bus";
    finding.repair = fmt::format("ip -details -statistics link show {}", interface);
  }
  return finding;
}

Finding CheckRestart(const std::string& interface, const CanLink& link) {
  if (link.restart_ms > 0) {
    return {"CAN restart", Verdict::kGood, fmt::format("{} ms after bus-off", link.restart_ms), ""};
  }
  return {"CAN restart", Verdict::kWarning, "never: after one bus-off the IMU stays silent",
          fmt::format("ip link set {0} down; ip link set {0} type can restart-ms 100; ip link set {0} up", interface)};
}

Finding CheckBitrate(const std::string& interface, const CanLink& link, const std::vector<CanMessage>& messages,
                     double hz) {
  const double load = MostLoad(messages, hz);
  const double share = load / static_cast<double>(link.bitrate);
  Finding finding{"CAN bit rate", Verdict::kGood,
                  fmt::format("{} bit/s; the IMU's {} messages at {:g} Hz take up to {:.0f} kbit/s, {:.0f} %",
                              link.bitrate, messages.size(), hz, load / 1e3, 100 * share),
                  ""};
  if (share <= kBusyShare) return finding;
  finding.verdict = share > 1.0 ? Verdict::kFailure : Verdict::kWarning;
  if (BitrateFor(load) <= link.bitrate) {
    finding.repair = "lower the IMU's rate: no classic CAN bus is faster";
    return finding;
  }
  finding.what += "; the IMU and all others on the bus have to be set to the new rate too";
  finding.repair = SetUp(interface, BitrateFor(load));
  return finding;
}

}  // namespace

std::optional<CanLink> ReadCanLink(const nlohmann::json& links) {
  if (links.empty()) return std::nullopt;
  const nlohmann::json& top = links.front();
  const nlohmann::json info = top.value("linkinfo", nlohmann::json::object());
  const nlohmann::json data = info.value("info_data", nlohmann::json::object());
  const auto flags = top.value("flags", std::vector<std::string>{});
  CanLink link;
  link.up = std::ranges::find(flags, "UP") != flags.end();
  link.is_can = top.value("link_type", "") == "can";
  link.state = data.value("state", "");
  link.bitrate = data.value("bittiming", nlohmann::json::object()).value("bitrate", std::int64_t{0});
  if (link.bitrate == 0) link.bitrate = data.value("bittiming_bitrate", std::int64_t{0});  // a choice of fixed rates
  link.restart_ms = data.value("restart_ms", std::int64_t{0});
  link.bus_off = info.value("info_xstats", nlohmann::json::object()).value("bus_off", std::int64_t{0});
  return link;
}

std::vector<Finding> CheckCan(const std::string& interface, const std::optional<CanLink>& link,
                              const std::vector<CanMessage>& messages, double hz) {
  const double load = MostLoad(messages, hz);
  if (!link || !link->is_can) {
    const std::string what = link ? interface + " is no CAN interface"
                                  : "there is no " + interface + "; is the adapter plugged in, its module loaded?";
    return {{"CAN interface", Verdict::kFailure, what, "ip -brief link show; dmesg | grep -i can"}};
  }
  if (!link->up) {
    const bool is_virtual = link->state.empty();
    return {{"CAN interface", Verdict::kFailure, fmt::format("{} is down", interface),
             is_virtual ? fmt::format("ip link set {} up", interface) : SetUp(interface, BitrateFor(load))}};
  }
  std::vector<Finding> findings{{"CAN interface", Verdict::kGood, fmt::format("{} is up", interface), ""}};
  if (link->state.empty()) {
    findings.back().what += "; it is virtual: no state, no bit rate";
    return findings;
  }
  findings.push_back(CheckState(interface, *link));
  findings.push_back(CheckRestart(interface, *link));
  if (link->bitrate > 0) findings.push_back(CheckBitrate(interface, *link, messages, hz));
  return findings;
}

Finding CheckCanKernel() {
  const int fd = ::socket(PF_CAN, SOCK_RAW, CAN_RAW);
  if (fd < 0) {
    return {"CAN in the kernel", Verdict::kFailure, fmt::format("none: {}", std::strerror(errno)),
            "modprobe -a can can-raw"};
  }
  ::close(fd);
  return {"CAN in the kernel", Verdict::kGood, "raw sockets open", ""};
}

}  // namespace mapweld::doctor
