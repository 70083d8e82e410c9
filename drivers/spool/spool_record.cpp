// SPDX-License-Identifier: Apache-2.0
#include "drivers/spool/spool_record.hpp"

#include "core/base/byte_io.hpp"
#include "core/base/crc32.hpp"

namespace mapweld::spool {

SegmentHeaderBytes EncodeSegmentHeader(const SegmentHeader& header) {
  SegmentHeaderBytes bytes{};
  ByteWriter writer(bytes);
  writer.Little(kSegmentMagic);
  writer.Little(kSpoolVersion);
  writer.Little(header.use);
  writer.Little(std::uint32_t{0});
  writer.Little(header.file_bytes);
  writer.Little(Crc32(writer.written()));
  return bytes;
}

Status DecodeSegmentHeader(const SegmentHeaderBytes& bytes, SegmentHeader* header) {
  ByteReader reader(bytes);
  if (reader.Little<std::uint32_t>() != kSegmentMagic) return Status::kBadInput;
  if (reader.Little<std::uint32_t>() != kSpoolVersion) return Status::kVersion;
  header->use = reader.Little<std::uint32_t>();
  reader.Skip(4);
  header->file_bytes = reader.Little<std::uint64_t>();
  const std::size_t covered = reader.position();
  return reader.Little<std::uint32_t>() == Crc32(std::span(bytes).first(covered)) ? Status::kOk : Status::kCrc;
}

RecordHeaderBytes EncodeRecordHeader(const RecordHeader& header) {
  RecordHeaderBytes bytes{};
  ByteWriter writer(bytes);
  writer.Little(kRecordMagic);
  writer.Little(header.use);
  writer.Little(std::uint32_t{header.kind});
  writer.Little(header.index);
  writer.Little(header.epoch);
  writer.Little(header.length);
  writer.Little(header.crc);
  writer.Little(Crc32(writer.written()));
  return bytes;
}

Status DecodeRecordHeader(const RecordHeaderBytes& bytes, RecordHeader* header) {
  ByteReader reader(bytes);
  if (reader.Little<std::uint32_t>() != kRecordMagic) return Status::kBadInput;
  header->use = reader.Little<std::uint32_t>();
  const auto kind = reader.Little<std::uint32_t>();
  header->kind = static_cast<std::uint8_t>(kind);
  header->index = reader.Little<std::int32_t>();
  header->epoch = reader.Little<std::int32_t>();
  header->length = reader.Little<std::uint32_t>();
  header->crc = reader.Little<std::uint32_t>();
  const std::size_t covered = reader.position();
  const bool whole = reader.Little<std::uint32_t>() == Crc32(std::span(bytes).first(covered)) && kind <= 0xFF;
  return whole ? Status::kOk : Status::kCrc;
}

}  // namespace mapweld::spool
