// SPDX-License-Identifier: Apache-2.0
// mapweld eval arrivals RESULT: how groups grow while drives arrive in random order.
#pragma once

#include <CLI/CLI.hpp>

namespace mapweld::eval {

void AddArrivalsCommand(CLI::App& eval);

}  // namespace mapweld::eval
