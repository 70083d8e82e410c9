// SPDX-License-Identifier: Apache-2.0
// mapweld eval viewpoint INPUT...: what turning and driving aside costs each descriptor.
#pragma once

#include <CLI/CLI.hpp>

namespace mapweld::eval {

void AddViewpointCommand(CLI::App& eval);

}  // namespace mapweld::eval
