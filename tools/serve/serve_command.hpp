// SPDX-License-Identifier: Apache-2.0
// mapweld serve -o OUT [--store CITY.db] [--agents N] [--submap-rate KB_PER_S] [--lcm-url URL] [--truth NAME=FILE]...
#pragma once

#include <CLI/CLI.hpp>

namespace mapweld::serve {

void AddServeCommand(CLI::App& app);

}  // namespace mapweld::serve
