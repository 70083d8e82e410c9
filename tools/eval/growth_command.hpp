// SPDX-License-Identifier: Apache-2.0
// mapweld eval growth LOG...: what a merge finds and costs while its drives grow.
#pragma once

#include <CLI/CLI.hpp>

namespace mapweld::eval {

void AddGrowthCommand(CLI::App& eval);

}  // namespace mapweld::eval
