// SPDX-License-Identifier: Apache-2.0
// A disk whose power may fail at any write. The program writes to a real file; afterwards every state is built that the
// disk may hold when the power goes after the n-th operation, by what becomes of the writes since the last sync.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

namespace mapweld::test {

// One thing that the program asked of the disk.
struct DiskOperation {
  enum Kind : std::uint8_t { kWrite, kTruncate, kSync } kind;
  std::uint64_t at = 0;             // kTruncate: the new size, which reads as zeros
  std::vector<std::uint8_t> bytes;  // of a write
};

enum class Unsynced : std::uint8_t { kLost, kKept, kReordered, kTorn };

// The file after `n` operations and then no power. Sizes are as if kept: the file is allocated in advance.
//   kLost       writes since the last sync never reached the disk
//   kKept       all of them did
//   kReordered  any of them did
//   kTorn       of the first, some sectors of 512 bytes did
inline std::vector<std::uint8_t> AfterPowerCut(const std::vector<DiskOperation>& operations, std::size_t n,
                                               Unsynced mode, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::size_t synced = 0;
  for (std::size_t i = 0; i < n; ++i) synced = operations[i].kind == DiskOperation::kSync ? i + 1 : synced;
  std::vector<std::uint8_t> disk;
  bool torn = false;
  for (std::size_t i = 0; i < n; ++i) {
    const DiskOperation& operation = operations[i];
    if (operation.kind == DiskOperation::kTruncate) {
      disk.assign(operation.at, 0);
    } else if (operation.kind == DiskOperation::kWrite) {
      const bool unsynced = i >= synced;
      if (disk.size() < operation.at + operation.bytes.size()) disk.resize(operation.at + operation.bytes.size());
      if (unsynced && (mode == Unsynced::kLost || torn || (mode == Unsynced::kReordered && random() % 2 == 0)))
        continue;
      for (std::size_t k = 0; k < operation.bytes.size(); ++k) {
        constexpr std::uint64_t kSector = 512;
        const std::uint64_t sector = (operation.at + k) / kSector;
        const bool sector_written = mode != Unsynced::kTorn || !unsynced || (sector * 2654435761U + seed) % 3 != 0;
        if (sector_written) disk[operation.at + k] = operation.bytes[k];
      }
      torn = unsynced && mode == Unsynced::kTorn;
    }
  }
  return disk;
}

}  // namespace mapweld::test
