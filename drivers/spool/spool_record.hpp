// SPDX-License-Identifier: Apache-2.0
// The layout of a spool file: a file header, then records one after the other, each starting on a multiple of 8. All
// integers are little-endian. A checksum covers header and content, so that a record cut off by a power failure is
// seen.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"

namespace mapweld::spool {

inline constexpr std::uint32_t kFileMagic = 0x5053574D;    // "MWSP"
inline constexpr std::uint32_t kRecordMagic = 0x4352574D;  // "MWRC"
inline constexpr std::uint32_t kSpoolVersion = 1;

struct FileHeader {
  static constexpr std::size_t kBytes = 32;
  std::int32_t epoch = 0;
  std::uint64_t file_bytes = 0;
};
using FileHeaderBytes = std::array<std::uint8_t, FileHeader::kBytes>;

struct RecordHeader {
  static constexpr std::size_t kBytes = 24;
  std::uint8_t kind = 0;
  std::int32_t index = 0;
  std::int32_t epoch = 0;
  std::uint32_t length = 0;  // of the content
  std::uint32_t crc = 0;
};
using RecordHeaderBytes = std::array<std::uint8_t, RecordHeader::kBytes>;

// Bytes a record takes in the file.
constexpr std::uint64_t RecordBytes(std::uint64_t length) {
  return (RecordHeader::kBytes + length + 7) / 8 * 8;
}

FileHeaderBytes EncodeFileHeader(const FileHeader& header);
// kBadInput, kVersion or kCrc.
Status DecodeFileHeader(const FileHeaderBytes& bytes, FileHeader* header);

// header.crc is written as it is: see RecordCrcSeed.
RecordHeaderBytes EncodeRecordHeader(const RecordHeader& header);
// kBadInput when there is no record.
Status DecodeRecordHeader(const RecordHeaderBytes& bytes, RecordHeader* header);

// Checksum over the header's fields, without `crc`, to be continued over the content.
std::uint32_t RecordCrcSeed(const RecordHeader& header);

}  // namespace mapweld::spool
