// SPDX-License-Identifier: Apache-2.0
// What people do with a store themselves:
//   mapweld fsck CITY.db [--json]            is it what was written?
//   mapweld history CITY.db                  every merge, and what it joined or split
//   mapweld explain CITY.db A B              why two drives are, or are not, in one map
//   mapweld undo CITY.db                     take back what the newest merge joined
//   mapweld withdraw CITY.db A B [--release] never accept the overlap of two drives
//   mapweld quarantine CITY.db DRIVE [--release]  leave a drive out; agent_3 means all its boots
#pragma once

#include <CLI/CLI.hpp>

namespace mapweld::store {

void AddStoreCommands(CLI::App& app);

}  // namespace mapweld::store
