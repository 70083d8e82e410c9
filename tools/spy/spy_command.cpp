// SPDX-License-Identifier: Apache-2.0
#include "tools/spy/spy_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "drivers/time/monotonic_clock.hpp"
#include "tools/spy/lcm_tap.hpp"
#include "tools/spy/traffic_view.hpp"

namespace mapweld::spy {
namespace {

volatile std::sig_atomic_t g_stop = 0;
void AskToStop(int) {
  g_stop = 1;
}

struct SpyOptions {
  std::string lcm_url;
  double seconds = 0;  // 0: until Ctrl-C
  bool json = false;
};

std::string DefaultUrl() {
  const char* url = std::getenv("LCM_DEFAULT_URL");
  return url != nullptr && url[0] != '\0' ? url : "udpm://239.255.76.67:7667?ttl=0";
}

// On a terminal the table is drawn afresh every second; elsewhere it is printed once, at the end.
void Run(const SpyOptions& options) {
  constexpr double kLiveWindow = 10;
  LcmTap tap(options.lcm_url);
  const TimeNs start = time::MonotonicNow();
  const bool live = options.seconds == 0 && !options.json && ::isatty(STDOUT_FILENO) != 0;
  const TimeNs end{options.seconds > 0 ? (start + FromSeconds(options.seconds)).ns : INT64_MAX};
  Traffic traffic(start, live ? FromSeconds(kLiveWindow) : DurationNs{INT64_MAX});
  std::signal(SIGINT, AskToStop);
  std::signal(SIGTERM, AskToStop);
  while (g_stop == 0 && time::MonotonicNow() < end) {
    const std::int64_t left_ms = (end - time::MonotonicNow()).ns / 1'000'000 + 1;
    tap.Listen(std::chrono::milliseconds(std::min<std::int64_t>(left_ms, 1000)), &traffic);
    if (!live) continue;
    fmt::print("\033[H\033[J{}last {:.0f} s; Ctrl-C ends\n",
               TrafficTable(traffic.Report(time::MonotonicNow()), options.lcm_url, tap.missed()), kLiveWindow);
    std::fflush(stdout);
  }
  if (live) return;
  const TrafficReport report = traffic.Report(time::MonotonicNow());
  fmt::print("{}", options.json ? TrafficJson(report, options.lcm_url, tap.missed())
                                : TrafficTable(report, options.lcm_url, tap.missed()));
}

}  // namespace

void AddSpyCommand(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("spy", "Show who says what on the LCM network, how often, what is lost");
  const auto options = std::make_shared<SpyOptions>();
  options->lcm_url = DefaultUrl();
  command->add_option("--lcm-url", options->lcm_url, "LCM network (LCM_DEFAULT_URL, else LCM's default)");
  command->add_option("--seconds", options->seconds, "listen that long, print once and end (until Ctrl-C)")
      ->check(CLI::Range(0.1, 1e6));
  command->add_flag("--json", options->json, "for programs, see docs/wire.md");
  command->callback([options] { Run(*options); });
}

}  // namespace mapweld::spy
