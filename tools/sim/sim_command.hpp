// SPDX-License-Identifier: Apache-2.0
// mapweld sim [SCENARIO.json] -o DIR [--vehicles 1,2] [--seed N] [--seconds S] [--threads N]
#pragma once

#include <CLI/CLI.hpp>

#include "tools/sim/simulate.hpp"

namespace mapweld::sim {

// Progress goes to stderr, one line per vehicle and ten percent; the summary to stdout. Returns the exit code.
int RunSim(const SimOptions& options);

// The callback throws CLI::RuntimeError with the exit code when the command fails; the message is already out then.
void AddSimCommand(CLI::App& app);

}  // namespace mapweld::sim
