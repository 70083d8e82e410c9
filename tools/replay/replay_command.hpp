// SPDX-License-Identifier: Apache-2.0
// mapweld replay DIR --agent N [--lidar-port P] [--host H] [--can vcan0] [--realtime] [--lcm-url URL]
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "tools/replay/network_link.hpp"

namespace mapweld::replay {

struct ReplayOptions {
  std::filesystem::path dir;
  NetworkOptions network;
  bool realtime = false;
};

// Progress goes to stderr, one summary line to stdout. Returns the exit code.
int RunReplay(const ReplayOptions& options);

// The callback throws CLI::RuntimeError with the exit code when the command fails; the message is already out then.
void AddReplayCommand(CLI::App& app);

}  // namespace mapweld::replay
