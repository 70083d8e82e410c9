// SPDX-License-Identifier: Apache-2.0
// mapweld merge DIR DIR ... -o OUT [--store CITY.db] [--truth NAME=FILE]... [--threads N]
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>

#include "tools/merge/crew.hpp"

namespace mapweld::merge {

// Makes the crew that does the work, once the arguments are known; it reports to the progress, which outlives it.
using MakeCrew = std::function<std::unique_ptr<Crew>(Progress* progress)>;

// make_crew: null for the threads of this process.
void AddMergeCommand(CLI::App& app, MakeCrew make_crew = nullptr);

}  // namespace mapweld::merge
