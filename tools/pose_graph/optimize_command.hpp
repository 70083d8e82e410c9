// SPDX-License-Identifier: Apache-2.0
// mapweld optimize IN.g2o -o OUT.g2o [--start given|better] [--max-iterations N]
#pragma once

#include <CLI/CLI.hpp>

namespace mapweld::pose_graph {

void AddOptimizeCommand(CLI::App& app);

}  // namespace mapweld::pose_graph
