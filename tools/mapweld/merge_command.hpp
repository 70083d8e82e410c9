// SPDX-License-Identifier: Apache-2.0
// mapweld merge DIR DIR ... -o OUT [--store CITY.db] [--truth NAME=FILE]... [--threads N]
#pragma once

#include <CLI/CLI.hpp>

namespace mapweld::merge {

void AddMergeCommand(CLI::App& app);

}  // namespace mapweld::merge
