// SPDX-License-Identifier: Apache-2.0
// mapweld describe RECORDING -o FILE.csv [--variant NAME]: the place descriptor of every keyframe, to compare with.
#pragma once

#include <CLI/CLI.hpp>

namespace mapweld::describe {

void AddDescribeCommand(CLI::App& app);

}  // namespace mapweld::describe
