// SPDX-License-Identifier: Apache-2.0
#include "drivers/spool/spool_record.hpp"

#include "core/base/byte_io.hpp"
#include "core/base/crc32.hpp"

namespace mapweld::spool {

FileHeaderBytes EncodeFileHeader(const FileHeader& header) {
  FileHeaderBytes bytes{};
  ByteWriter writer(bytes);
  writer.Little(kFileMagic);
  writer.Little(kSpoolVersion);
  writer.Little(header.epoch);
  writer.Little(std::uint32_t{0});
  writer.Little(header.file_bytes);
  writer.Little(Crc32(writer.written()));
  return bytes;
}

Status DecodeFileHeader(const FileHeaderBytes& bytes, FileHeader* header) {
  ByteReader reader(bytes);
  if (reader.Little<std::uint32_t>() != kFileMagic) return Status::kBadInput;
  if (reader.Little<std::uint32_t>() != kSpoolVersion) return Status::kVersion;
  header->epoch = reader.Little<std::int32_t>();
  reader.Skip(4);
  header->file_bytes = reader.Little<std::uint64_t>();
  const std::size_t covered = reader.position();
  return reader.Little<std::uint32_t>() == Crc32(std::span(bytes).first(covered)) ? Status::kOk : Status::kCrc;
}

RecordHeaderBytes EncodeRecordHeader(const RecordHeader& header) {
  RecordHeaderBytes bytes{};
  ByteWriter writer(bytes);
  writer.Little(kRecordMagic);
  writer.Little(std::uint32_t{header.kind});
  writer.Little(header.index);
  writer.Little(header.epoch);
  writer.Little(header.length);
  writer.Little(header.crc);
  return bytes;
}

Status DecodeRecordHeader(const RecordHeaderBytes& bytes, RecordHeader* header) {
  ByteReader reader(bytes);
  if (reader.Little<std::uint32_t>() != kRecordMagic) return Status::kBadInput;
  const auto kind = reader.Little<std::uint32_t>();
  if (kind > 0xFF) return Status::kBadInput;
  header->kind = static_cast<std::uint8_t>(kind);
  header->index = reader.Little<std::int32_t>();
  header->epoch = reader.Little<std::int32_t>();
  header->length = reader.Little<std::uint32_t>();
  header->crc = reader.Little<std::uint32_t>();
  return Status::kOk;
}

std::uint32_t RecordCrcSeed(const RecordHeader& header) {
  const RecordHeaderBytes bytes = EncodeRecordHeader(header);
  return Crc32(std::span(bytes).first(RecordHeader::kBytes - sizeof(header.crc)));
}

}  // namespace mapweld::spool
