// SPDX-License-Identifier: Apache-2.0
// The layout of a spool file: kSegments parts of equal size. Each begins with a header and holds records one after the
// other, each starting on a multiple of 8. All integers are little-endian. Headers and contents have checksums, so that
// a record cut off by a power failure is seen; a record names the use of its segment, so that what lay there before is
// never taken for new.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"

namespace mapweld::spool {

inline constexpr std::uint32_t kSegmentMagic = 0x5053574D;  // "MWSP"
inline constexpr std::uint32_t kRecordMagic = 0x4352574D;   // "MWRC"
inline constexpr std::uint32_t kSpoolVersion = 2;
inline constexpr std::size_t kSegments = 4;

struct SegmentHeader {
  static constexpr std::size_t kBytes = 32;
  std::uint32_t use = 0;         // 1, 2, 3 ... in the order in which segments were begun; the largest is being filled
  std::uint64_t file_bytes = 0;  // of the whole file
};
using SegmentHeaderBytes = std::array<std::uint8_t, SegmentHeader::kBytes>;

struct RecordHeader {
  static constexpr std::size_t kBytes = 32;
  std::uint32_t use = 0;  // of its segment
  std::uint8_t kind = 0;
  std::int32_t index = 0;
  std::int32_t epoch = 0;
  std::uint32_t length = 0;  // of the content
  std::uint32_t crc = 0;     // of the content
};
using RecordHeaderBytes = std::array<std::uint8_t, RecordHeader::kBytes>;

// Bytes a record takes in the file.
constexpr std::uint64_t RecordBytes(std::uint64_t length) {
  return (RecordHeader::kBytes + length + 7) / 8 * 8;
}

SegmentHeaderBytes EncodeSegmentHeader(const SegmentHeader& header);
// kBadInput, kVersion or kCrc.
Status DecodeSegmentHeader(const SegmentHeaderBytes& bytes, SegmentHeader* header);

RecordHeaderBytes EncodeRecordHeader(const RecordHeader& header);
// kBadInput when there is no record, kCrc when its header is damaged.
Status DecodeRecordHeader(const RecordHeaderBytes& bytes, RecordHeader* header);

}  // namespace mapweld::spool
