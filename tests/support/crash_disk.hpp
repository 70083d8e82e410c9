// SPDX-License-Identifier: Apache-2.0
// A disk for SQLite that exists in memory only: every operation is written down, any of them can be made to fail, and
// afterwards the disk can be built as it may be when the power went after the n-th operation.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tests/support/cut_power.hpp"

namespace mapweld::test {

class CrashDisk {
 public:
  using Files = std::map<std::string, std::vector<std::uint8_t>>;

  // Registers itself with SQLite under a name of its own for as long as it lives.
  explicit CrashDisk(Files files = {});
  ~CrashDisk();
  CrashDisk(const CrashDisk&) = delete;
  CrashDisk& operator=(const CrashDisk&) = delete;

  [[nodiscard]] const char* vfs() const { return name_.c_str(); }
  [[nodiscard]] const Files& files() const { return files_; }
  // Writes, truncations, syncs and deletions so far.
  [[nodiscard]] std::size_t operations() const { return log_.size(); }

  // The n-th operation from now (0: the next) fails with `code`, for example SQLITE_FULL; with `for_ever` all later
  // ones too. Failed operations are counted and change nothing.
  void FailAt(std::size_t n, int code, bool for_ever);
  void StopFailing() { fail_code_ = SQLITE_OK; }
  [[nodiscard]] bool has_failed() const { return has_failed_; }

  // What the disk may hold when the power goes after n operations; see AfterPowerCut for the modes. Files that were
  // there when the CrashDisk was made are there.
  [[nodiscard]] Files AfterCut(std::size_t n, Unsynced mode, std::uint32_t seed) const;

 private:
  friend struct CrashFile;
  friend struct CrashVfs;
  struct Operation {
    enum Kind : std::uint8_t { kWrite, kTruncate, kSync, kDelete } kind = kWrite;
    std::string file;
    std::uint64_t at = 0;  // of a write; the size of a truncation
    std::vector<std::uint8_t> bytes;
  };
  // SQLITE_OK, or the code with which the operation has to fail.
  int Count(Operation operation);

  std::string name_;
  sqlite3_vfs vfs_{};
  Files initial_;
  Files files_;
  std::vector<Operation> log_;
  std::size_t calls_ = 0;
  std::size_t fail_at_ = 0;
  int fail_code_ = SQLITE_OK;
  bool for_ever_ = false;
  bool has_failed_ = false;
};

}  // namespace mapweld::test
