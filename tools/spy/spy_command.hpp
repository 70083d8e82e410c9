// SPDX-License-Identifier: Apache-2.0
// mapweld spy [--lcm-url URL] [--seconds N] [--json]
#pragma once

#include <CLI/CLI.hpp>

namespace mapweld::spy {

void AddSpyCommand(CLI::App& app);

}  // namespace mapweld::spy
