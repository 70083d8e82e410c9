// SPDX-License-Identifier: Apache-2.0
// Writes a file aside and puts it in place only when all of it is on the disk, so that no reader ever sees half a map
// and a full disk never costs the old file.
//
// The temporary lies beside the target and disappears again unless Commit succeeds. A target that is not an ordinary
// file (a pipe, /dev/stdout) is written directly. Every step is checked, also the closing one; each failure throws one
// sentence with the path, the reason and the remedy.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace mapweld::io {

class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void Write(std::string_view text);
  void Write(std::span<const std::uint8_t> bytes);
  // Flushes, syncs, closes and renames. Nothing may be written afterwards.
  void Commit();

  // Unlinks what unfinished files of this process have written so far, and lets none be put in place any more. For a
  // program that is about to end without unwinding.
  static void RemoveTemporaries();

 private:
  void Flush();
  [[noreturn]] void Fail(int error);
  void Abandon();

  std::filesystem::path target_;
  std::filesystem::path written_;  // the temporary, or the target itself when that is a device
  int fd_ = -1;
  std::string buffer_;
};

// The whole of a small file in one call.
void WriteFileAtomically(const std::filesystem::path& target, std::string_view text);

}  // namespace mapweld::io
