// SPDX-License-Identifier: Apache-2.0
// Keyframes and submaps on the disk, those of earlier boots too, so that they can be sent when the host asks for them.
// One file of fixed size in kSegments segments, filled one after the other; when all are full, the one filled first is
// given up and used again: what is lost is the oldest, and counted. A restart finds every record again that was whole
// on the disk. Owns the index, 16 bytes per record of kCap.spool_records. No heap. Look-up: one pass over the index.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/fixed_vector.hpp"
#include "core/base/status.hpp"
#include "core/config/capacity.hpp"
#include "drivers/spool/spool_record.hpp"

namespace mapweld::spool {

class RecordSpool {
 public:
  static constexpr std::uint64_t kMaxFileBytes = 8ULL << 32U;   // offsets are kept in units of 8 bytes
  static constexpr std::uint32_t kMaxContentBytes = 0xFF'FFFF;  // of one record

  struct Counters {
    std::uint64_t appended = 0;
    std::uint64_t appended_bytes = 0;
    std::uint64_t recovered = 0;  // records found again at Open
    std::uint64_t given_up = 0;   // old ones, for the sake of new ones
    std::uint64_t full = 0;       // new ones dropped: larger than a segment, or the index is full of its records
    std::uint64_t io_errors = 0;
    std::uint64_t crc_errors = 0;  // records that read back wrong
  };

  // What a record is of. Boots share no keyframe numbers.
  struct Key {
    std::int32_t epoch = 0;
    std::uint8_t kind = 0;
    std::int32_t index = 0;
    bool operator==(const Key&) const = default;
  };

  RecordSpool() = default;
  ~RecordSpool() { Close(); }
  RecordSpool(const RecordSpool&) = delete;
  RecordSpool& operator=(const RecordSpool&) = delete;

  // Reserves `bytes` on the disk; a file of another size starts empty. kIo with errno: no room on the disk, no
  // permission, or another process has the file open (EWOULDBLOCK); kOutOfRange for a size too small for one record per
  // segment or larger than kMaxFileBytes.
  Status Open(const char* path, std::uint64_t bytes);
  void Close();

  // kFull and kIo are counted; the spool stays usable. A later record of the same key takes the place of the earlier
  // one. Not yet safe from a power failure: see Sync.
  Status Append(const Key& key, std::span<const std::uint8_t> content);

  // Bytes read into `out`. kEmpty when there is none, kFull when `out` is too small, kCrc when the disk changed it.
  Result<std::size_t> Read(const Key& key, std::span<std::uint8_t> out);

  // Everything appended so far survives a power failure. May wait for the disk.
  Status Sync();

  [[nodiscard]] bool Has(const Key& key) const { return Find(key) != nullptr; }
  // The record with the largest index among those of `kind` of the newest boot before `epoch`; kEmpty when there is
  // none. Called with the epoch it gives, it goes on to earlier boots.
  Status LastBefore(std::int32_t epoch, std::uint8_t kind, Key* last) const;

  [[nodiscard]] std::size_t size() const { return index_.size(); }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  struct Entry {
    std::int32_t epoch;
    std::int32_t index;
    std::uint32_t offset8;      // of the record, in units of 8 bytes
    std::uint32_t length_kind;  // length << 8 | kind
    [[nodiscard]] Key key() const { return {epoch, static_cast<std::uint8_t>(length_kind), index}; }
    [[nodiscard]] std::uint32_t length() const { return length_kind >> 8U; }
  };
  static_assert(sizeof(Entry) == 16);

  Status Start();
  bool Recover();
  [[nodiscard]] std::size_t FirstAfter(std::uint32_t done) const;
  bool RecoverRecord(bool may_be_torn);
  [[nodiscard]] bool ContentIsWhole(std::uint64_t at, const RecordHeader& header) const;
  Status BeginSegment(std::size_t segment, std::uint32_t use);
  void Forget(std::size_t segment);
  bool MakeRoomInIndex();
  void Remember(std::uint64_t at, const RecordHeader& header);
  [[nodiscard]] std::size_t Next() const;
  [[nodiscard]] std::uint64_t Begin(std::size_t segment) const { return segment * segment_bytes_; }
  [[nodiscard]] std::size_t SegmentOf(const Entry& entry) const {
    return static_cast<std::size_t>(std::uint64_t{entry.offset8} * 8 / segment_bytes_);
  }
  [[nodiscard]] std::uint64_t Room() const { return segment_bytes_ - end_; }
  [[nodiscard]] const Entry* Find(const Key& key) const;

  int fd_ = -1;
  std::uint64_t file_bytes_ = 0;
  std::uint64_t segment_bytes_ = 0;
  std::array<std::uint32_t, kSegments> use_{};  // 0: empty
  std::size_t active_ = 0;
  std::uint64_t end_ = 0;                         // in the active segment: where the next record goes
  FixedVector<Entry, kCap.spool_records> index_;  // from the oldest to the newest
  Counters counters_;
};

}  // namespace mapweld::spool
