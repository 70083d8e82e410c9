// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/host_checks.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "drivers/spool/boot_epoch.hpp"
#include "drivers/time/monotonic_clock.hpp"

namespace mapweld::doctor {
namespace {

constexpr const char* kClockSources = "/sys/devices/system/clocksource/clocksource0/";

std::string FirstLine(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

// The best of many short runs: in the others this program may have waited for a processor.
double NanosecondsPerReading() {
  constexpr int kReadings = 100;
  double best = 1e9;
  for (int run = 0; run < 100; ++run) {
    const TimeNs begin = time::MonotonicNow();
    TimeNs end = begin;
    for (int i = 0; i < kReadings; ++i) end = time::MonotonicNow();
    best = std::min(best, static_cast<double>((end - begin).ns) / kReadings);
  }
  return best;
}

bool EffectiveCapability(int number) {
  std::ifstream in("/proc/self/status");
  for (std::string word; in >> word;) {
    if (word != "CapEff:") continue;
    in >> word;
    return (std::stoull(word, nullptr, 16) >> number & 1U) != 0;
  }
  return false;
}

}  // namespace

Finding CheckClockSource(const std::string& current, const std::string& available, double read_ns) {
  constexpr double kSlowNs = 1000;
  const std::string what = fmt::format("{}, {:.0f} ns per reading", current.empty() ? "unknown" : current, read_ns);
  if (read_ns <= kSlowNs) return {"clock source", Verdict::kGood, what, ""};
  for (const char* fast : {"tsc", "arch_sys_counter", "kvm-clock"}) {
    if (current == fast || available.find(fast) == std::string::npos) continue;
    return {"clock source", Verdict::kWarning, what + ": every receive stamp pays for it",
            fmt::format("echo {} > {}current_clocksource", fast, kClockSources)};
  }
  return {"clock source", Verdict::kWarning,
          what + ", and this machine has no faster one; every receive stamp pays for it",
          fmt::format("dmesg | grep -i clocksource  # why; all: {}", available)};
}

Finding CheckClockSource() {
  const std::string folder = kClockSources;
  return CheckClockSource(FirstLine(folder + "current_clocksource"), FirstLine(folder + "available_clocksource"),
                          NanosecondsPerReading());
}

Finding CheckMemoryLock(std::uint64_t agent_bytes) {
  constexpr int kCapIpcLock = 14;
  rlimit limit{};
  (void)::getrlimit(RLIMIT_MEMLOCK, &limit);
  if (EffectiveCapability(kCapIpcLock) || limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= agent_bytes) {
    return {"memory lock", Verdict::kGood, "permitted", ""};
  }
  return {"memory lock", Verdict::kWarning,
          fmt::format("limited to {} KiB: page faults can stall the odometry", limit.rlim_cur >> 10U),
          "setcap cap_ipc_lock,cap_net_admin+ep $(command -v mapweld-agent)"};
}

Finding CheckStateDirectory(const std::string& path, std::uint64_t spool_bytes) {
  namespace fs = std::filesystem;
  const auto failed = [](const std::string& what, const std::string& repair) {
    return Finding{"state directory", Verdict::kFailure, what, repair};
  };
  std::error_code error;
  if (!fs::is_directory(path, error)) return failed(path + " is not there", fmt::format("mkdir -p {}", path));
  if (::access(path.c_str(), R_OK | W_OK | X_OK) != 0) {
    return failed(fmt::format("{}: {}", path, std::strerror(errno)), fmt::format("chown $(id -u) {}", path));
  }
  const fs::path epoch = fs::path(path) / spool::kEpochFile;
  const std::string count = fs::exists(epoch, error) ? FirstLine(epoch.string()) : "0";
  if (count.empty() || count.size() > 10 || count.find_first_not_of("0123456789") != std::string::npos) {
    return failed(fmt::format("{} does not hold a boot count", epoch.string()),
                  fmt::format("echo N > {}  # N: larger than any boot count this vehicle ever had", epoch.string()));
  }
  struct statvfs disk {};
  if (::statvfs(path.c_str(), &disk) != 0)
    return failed(fmt::format("{}: {}", path, std::strerror(errno)), "df " + path);
  const std::uint64_t there = fs::file_size(fs::path(path) / "spool", error);
  const std::uint64_t free = std::uint64_t{disk.f_bavail} * disk.f_frsize + (error ? 0 : there);
  if (free < spool_bytes) {
    return failed(fmt::format("{} MiB free, the spool takes {}", free >> 20U, spool_bytes >> 20U),
                  fmt::format("mapweld-agent --spool-mib {}", free >> 21U));
  }
  return {"state directory", Verdict::kGood, fmt::format("{} writable, last boot {}", path, count), ""};
}

}  // namespace mapweld::doctor
