// SPDX-License-Identifier: Apache-2.0
// Keyframes and submaps of the present drive on the disk, so that they can be sent when the host asks for them. One
// file of fixed size, filled from the front; when it is full the newcomer is dropped and counted. A restart within the
// same epoch finds every record again that was whole on the disk; another epoch starts empty. Owns the index, 16 bytes
// per record of kCap.spool_records. No heap. Look-up: one pass over the index.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"
#include "core/config/capacity.hpp"
#include "drivers/spool/spool_record.hpp"

namespace mapweld::spool {

class RecordSpool {
 public:
  static constexpr std::uint64_t kMaxFileBytes = 8ULL << 32U;  // offsets are kept in units of 8 bytes

  struct Counters {
    std::uint64_t appended = 0;
    std::uint64_t appended_bytes = 0;
    std::uint64_t recovered = 0;  // records found again at Open
    std::uint64_t full = 0;       // dropped: no room in the file or in the index
    std::uint64_t io_errors = 0;
    std::uint64_t crc_errors = 0;  // records that read back wrong
  };

  RecordSpool() = default;
  ~RecordSpool() { Close(); }
  RecordSpool(const RecordSpool&) = delete;
  RecordSpool& operator=(const RecordSpool&) = delete;

  // Reserves `bytes` on the disk. kIo with errno: no room on the disk, no permission, or another process has the file
  // open (EWOULDBLOCK); kOutOfRange for a size too small for one record or larger than kMaxFileBytes.
  Status Open(const char* path, std::uint64_t bytes, std::int32_t epoch);
  void Close();

  // kFull and kIo are counted; the spool stays usable. A later record of the same kind and index takes the place of the
  // earlier one. Not yet safe from a power failure: see Sync.
  Status Append(std::uint8_t kind, std::int32_t index, std::span<const std::uint8_t> content);

  // Bytes read into `out`. kEmpty when there is none, kFull when `out` is too small, kCrc when the disk changed it.
  Result<std::size_t> Read(std::uint8_t kind, std::int32_t index, std::span<std::uint8_t> out);

  // Everything appended so far survives a power failure. May wait for the disk.
  Status Sync();

  [[nodiscard]] bool Has(std::uint8_t kind, std::int32_t index) const { return Find(kind, index) != nullptr; }
  [[nodiscard]] std::size_t size() const { return records_; }
  [[nodiscard]] std::uint64_t free_bytes() const { return file_bytes_ - end_; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  struct Entry {
    std::int32_t index;
    std::uint32_t offset8;  // of the record, in units of 8 bytes
    std::uint32_t length;
    std::uint8_t kind;
  };
  static_assert(sizeof(Entry) == 16);

  Status Start(std::uint64_t bytes, std::int32_t epoch);
  bool Recover(std::uint64_t bytes, std::int32_t epoch);
  bool RecoverRecord();
  void Remember(const RecordHeader& header);
  [[nodiscard]] const Entry* Find(std::uint8_t kind, std::int32_t index) const;

  int fd_ = -1;
  std::int32_t epoch_ = 0;
  std::uint64_t file_bytes_ = 0;
  std::uint64_t end_ = 0;  // where the next record goes
  std::size_t records_ = 0;
  std::array<Entry, kCap.spool_records> index_{};
  Counters counters_;
};

}  // namespace mapweld::spool
