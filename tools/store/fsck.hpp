// SPDX-License-Identifier: Apache-2.0
// Is the store what it was when it was written? SQLite's own check of the structure, the checksum of every record, and
// whether what records name is there.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/store/city_store.hpp"

namespace mapweld::store {

struct FsckReport {
  std::vector<std::string> structure;  // what SQLite says, line by line
  std::vector<std::string>
      damaged;  // records whose bytes are not those written: they are left out when the store is used
  std::vector<std::string> dangling;  // records that name something that is not there
  std::int64_t drives = 0;
  std::int64_t keyframes = 0;
  std::int64_t submaps = 0;
  std::int64_t merges = 0;
  [[nodiscard]] bool Clean() const { return structure.empty() && damaged.empty() && dangling.empty(); }
};

// Reads every byte once. A table that cannot be read on is named in `structure`.
FsckReport Fsck(CityStore* store);

std::string ToJson(const FsckReport& report);
std::string ToText(const FsckReport& report, const std::string& path);

}  // namespace mapweld::store
