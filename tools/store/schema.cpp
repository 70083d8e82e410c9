// SPDX-License-Identifier: Apache-2.0
#include "tools/store/schema.hpp"

#include <fmt/format.h>

#include <initializer_list>

namespace mapweld::store {
namespace {

std::string Tables(std::initializer_list<const char*> names) {
  std::string sql;
  for (const char* name : names) sql += TableDefinition(name) + ";";
  return sql;
}

}  // namespace

std::string TableDefinition(const std::string& name) {
  return fmt::format("CREATE TABLE {}(id INTEGER PRIMARY KEY, body BLOB NOT NULL, crc INTEGER NOT NULL)", name);
}

std::string UpgradeFrom(std::int64_t version) {
  std::string sql;
  if (version < 1) sql += Tables({"drives", "keyframes", "submaps", "trajectories", "merges"});
  if (version < 2) sql += Tables({"pairs", "rulings"});
  return sql + fmt::format("PRAGMA application_id={};PRAGMA user_version={};", kApplicationId, kSchemaVersion);
}

}  // namespace mapweld::store
