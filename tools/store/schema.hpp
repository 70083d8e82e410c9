// SPDX-License-Identifier: Apache-2.0
// The tables of a store and how they came to be. Every table is (id INTEGER PRIMARY KEY, body BLOB, crc INTEGER).
//   version 1  drives, keyframes, submaps, trajectories, merges
//   version 2  pairs: what a merge found between two drives; rulings: what people decided
#pragma once

#include <cstdint>
#include <string>

namespace mapweld::store {

inline constexpr std::int64_t kSchemaVersion = 2;
inline constexpr std::int64_t kApplicationId = 0x4D57454C;  // "MWEL", in the header of the file

// The statements that bring a store from `version` (0: an empty file) to kSchemaVersion.
std::string TableDefinition(const std::string& name);
std::string UpgradeFrom(std::int64_t version);

}  // namespace mapweld::store
