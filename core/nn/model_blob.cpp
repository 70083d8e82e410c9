// SPDX-License-Identifier: Apache-2.0
#include "core/nn/model_blob.hpp"

#include <algorithm>

#include "core/base/byte_io.hpp"
#include "core/base/crc32.hpp"

namespace mapweld::nn {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::string_view kMagic("MWMODEL\0", 8);
constexpr std::size_t kChecked = 20;  // the checksum covers everything from here

struct Header {
  std::uint32_t tensors = 0;
  std::string_view name;
};

struct Entry {
  std::string_view name;
  std::uint32_t type = 0;
  Shape shape{};
  std::uint32_t offset = 0;
  std::uint32_t size = 0;
  std::uint32_t reserved = 0;
};

// The text up to its zero; empty when there is no zero, or something other than zeros behind it.
std::string_view PaddedText(Bytes field) {
  const std::string_view text(reinterpret_cast<const char*>(field.data()), field.size());
  const std::size_t end = text.find('\0');
  if (end == std::string_view::npos || text.find_first_not_of('\0', end) != std::string_view::npos) return {};
  return text.substr(0, end);
}

bool AllZero(Bytes bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t b) { return b == 0; });
}

Entry ReadEntry(Bytes blob, std::size_t index) {
  ByteReader reader(blob.subspan(ModelBlob::kHeaderBytes + index * ModelBlob::kEntryBytes, ModelBlob::kEntryBytes));
  Entry entry;
  entry.name = PaddedText(reader.Bytes(ModelBlob::kNameBytes));
  entry.type = reader.Little<std::uint32_t>();
  for (std::uint32_t& d : entry.shape) d = reader.Little<std::uint32_t>();
  entry.offset = reader.Little<std::uint32_t>();
  entry.size = reader.Little<std::uint32_t>();
  entry.reserved = reader.Little<std::uint32_t>();
  return entry;
}

BlobFault CheckHeader(Bytes blob, Header* header) {
  if (blob.size() < ModelBlob::kHeaderBytes) return BlobFault::kTooShort;
  if (reinterpret_cast<std::uintptr_t>(blob.data()) % ModelBlob::kAlignment != 0) return BlobFault::kMisaligned;
  ByteReader reader(blob);
  const Bytes magic = reader.Bytes(kMagic.size());
  if (!std::equal(magic.begin(), magic.end(), kMagic.begin())) return BlobFault::kMagic;
  if (reader.Little<std::uint32_t>() != ModelBlob::kVersion) return BlobFault::kVersion;
  if (reader.Little<std::uint32_t>() != blob.size()) return BlobFault::kSize;
  if (reader.Little<std::uint32_t>() != Crc32(blob.subspan(kChecked))) return BlobFault::kChecksum;
  header->tensors = reader.Little<std::uint32_t>();
  const Bytes reserved = reader.Bytes(8);
  header->name = PaddedText(reader.Bytes(64));
  if (header->name.empty()) return BlobFault::kName;
  if (!AllZero(reserved) || !AllZero(reader.Bytes(32))) return BlobFault::kDirectory;
  if (header->tensors > ModelBlob::kMaxTensors ||
      header->tensors > (blob.size() - ModelBlob::kHeaderBytes) / ModelBlob::kEntryBytes) {
    return BlobFault::kDirectory;
  }
  return BlobFault::kNone;
}

BlobFault CheckShape(const Entry& entry) {
  const bool is_int8 = entry.type == static_cast<std::uint32_t>(TensorType::kInt8);
  std::uint64_t product = is_int8 ? 1 : 4;
  bool ended = false;
  for (const std::uint32_t d : entry.shape) {
    if (d != 0 && ended) return BlobFault::kShape;
    ended = d == 0;
    if (ended) continue;
    product *= d;
    if (product > entry.size) return BlobFault::kShape;  // also keeps the product small
  }
  return entry.shape[0] != 0 && product == entry.size ? BlobFault::kNone : BlobFault::kShape;
}

BlobFault CheckTensors(Bytes blob, std::size_t tensors) {
  std::uint64_t free_from = ModelBlob::kHeaderBytes + tensors * ModelBlob::kEntryBytes;
  for (std::size_t i = 0; i < tensors; ++i) {
    const Entry entry = ReadEntry(blob, i);
    if (entry.name.empty()) return BlobFault::kName;
    for (std::size_t other = 0; other < i; ++other) {
      if (ReadEntry(blob, other).name == entry.name) return BlobFault::kName;
    }
    if (entry.type < static_cast<std::uint32_t>(TensorType::kInt8) ||
        entry.type > static_cast<std::uint32_t>(TensorType::kFloat32)) {
      return BlobFault::kType;
    }
    if (entry.reserved != 0) return BlobFault::kDirectory;
    if (const BlobFault fault = CheckShape(entry); fault != BlobFault::kNone) return fault;
    if (entry.offset % ModelBlob::kAlignment != 0) return BlobFault::kMisaligned;
    if (entry.offset < free_from) return BlobFault::kOverlap;
    free_from = std::uint64_t{entry.offset} + entry.size;
    if (free_from > blob.size()) return BlobFault::kOverlap;
  }
  return BlobFault::kNone;
}

}  // namespace

const char* BlobFaultName(BlobFault fault) {
  switch (fault) {
    case BlobFault::kNone:
      return "none";
    case BlobFault::kTooShort:
      return "shorter than a header";
    case BlobFault::kMagic:
      return "not a model";
    case BlobFault::kVersion:
      return "another format version";
    case BlobFault::kSize:
      return "another size than its header says";
    case BlobFault::kChecksum:
      return "checksum mismatch";
    case BlobFault::kDirectory:
      return "broken directory";
    case BlobFault::kName:
      return "broken or repeated name";
    case BlobFault::kType:
      return "unknown element type";
    case BlobFault::kShape:
      return "shape and size disagree";
    case BlobFault::kMisaligned:
      return "misaligned";
    case BlobFault::kOverlap:
      return "tensors overlap or leave the blob";
  }
  return "unknown";
}

Status ModelBlob::Open(std::span<const std::uint8_t> bytes) {
  *this = ModelBlob{};
  Header header;
  fault_ = CheckHeader(bytes, &header);
  if (fault_ == BlobFault::kNone) fault_ = CheckTensors(bytes, header.tensors);
  switch (fault_) {
    case BlobFault::kNone:
      break;
    case BlobFault::kMagic:
    case BlobFault::kVersion:
      return Status::kVersion;
    case BlobFault::kChecksum:
      return Status::kCrc;
    default:
      return Status::kBadInput;
  }
  bytes_ = bytes;
  name_ = header.name;
  tensors_ = header.tensors;
  return Status::kOk;
}

Result<std::span<const std::uint8_t>> ModelBlob::FindBytes(std::string_view name, TensorType type,
                                                           const Shape& shape) const {
  for (std::size_t i = 0; i < tensors_; ++i) {
    const Entry entry = ReadEntry(bytes_, i);
    if (entry.name != name) continue;
    if (entry.type != static_cast<std::uint32_t>(type) || entry.shape != shape) return Status::kVersion;
    return bytes_.subspan(entry.offset, entry.size);
  }
  return Status::kEmpty;
}

}  // namespace mapweld::nn
