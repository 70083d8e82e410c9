// SPDX-License-Identifier: Apache-2.0
// One SQLite file of checksummed records. Knows tables, keys and bytes; what the bytes mean is record_codec.hpp.
//
// Durability: write-ahead log, synchronous FULL: what a transaction wrote is on the disk when it has returned, through
// a crash or a power failure at any moment. One process at a time: the file is locked until the object goes, and the
// lock of a killed process goes with it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace mapweld::store {

using Bytes = std::vector<std::uint8_t>;

// One sentence: the file, what happened, what to do.
class StoreError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class Table : std::uint8_t { kDrives, kKeyframes, kSubmaps, kTrajectories, kPairs, kMerges, kRulings };
inline constexpr std::array<const char*, 7> kTableNames = {"drives", "keyframes", "submaps", "trajectories",
                                                           "pairs",  "merges",    "rulings"};

// The key of a record of one drive and one keyframe, or of two drives.
constexpr std::int64_t PairKey(std::int64_t high, std::int32_t low) {
  return (high << 32U) | static_cast<std::uint32_t>(low);
}
constexpr std::int64_t HighOf(std::int64_t key) {
  return key >> 32U;
}
constexpr std::int32_t LowOf(std::int64_t key) {
  return static_cast<std::int32_t>(key & 0x7FFFFFFF);
}

struct Record {
  std::int64_t key = 0;
  Bytes body;
  bool damaged = false;  // the bytes are not those that were written
};

class Database {
 public:
  enum class Mode { kCreate, kExisting };
  // kExisting throws when there is no such file. Throws StoreError when another process has it, when it is no store,
  // or when a newer program wrote it; one of an older program is brought up to date. vfs: of SQLite, null for its own.
  Database(const std::filesystem::path& path, Mode mode, const char* vfs = nullptr);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  // Everything that `writes` does is on the disk when this returns, or, when it throws, none of it. May be nested; the
  // outermost counts. Other threads wait.
  void Transaction(const std::function<void()>& writes);

  // Takes the place of an earlier record. Outside of a Transaction each is one of its own.
  void Put(Table table, std::int64_t key, std::span<const std::uint8_t> body);
  void Remove(Table table, std::int64_t key);
  [[nodiscard]] std::optional<Record> Get(Table table, std::int64_t key);
  // In ascending order of the keys, those in [first, last]. `take` must not read from the database.
  void ForEach(Table table, std::int64_t first, std::int64_t last, const std::function<void(Record)>& take);
  [[nodiscard]] std::vector<std::int64_t> Keys(Table table, std::int64_t first = 0, std::int64_t last = INT64_MAX);

  // What SQLite itself says about the structure of the file; empty when all is well.
  [[nodiscard]] std::vector<std::string> CheckStructure();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  class Statement;
  void Open(Mode mode, const char* vfs);
  void Execute(const std::string& sql);
  [[nodiscard]] std::int64_t Number(const std::string& sql);
  sqlite3_stmt* Prepared(const std::string& sql);
  [[noreturn]] void Fail(int code);
  void Close();

  std::filesystem::path path_;
  sqlite3* sqlite_ = nullptr;
  std::recursive_mutex mutex_;
  int depth_ = 0;
  std::vector<std::pair<std::string, sqlite3_stmt*>> statements_;
};

// Changes whenever table, key or body do.
std::uint32_t RecordChecksum(Table table, std::int64_t key, std::span<const std::uint8_t> body);

}  // namespace mapweld::store
