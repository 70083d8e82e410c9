// SPDX-License-Identifier: Apache-2.0
// A small model blob, and the header of a changed one made right again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "core/base/crc32.hpp"
#include "core/nn/model_blob.hpp"

namespace mapweld::nn {

struct MadeUpTensor {
  std::string name;
  TensorType type = TensorType::kInt8;
  Shape shape{};
  std::vector<std::uint8_t> bytes;
};

inline void PutNumber(std::span<std::uint8_t> blob, std::size_t at, std::uint32_t value) {
  std::memcpy(blob.subspan(at, 4).data(), &value, 4);
}

// Size and checksum as they have to be.
inline void RepairHeader(std::span<std::uint8_t> blob) {
  if (blob.size() < ModelBlob::kHeaderBytes) return;
  PutNumber(blob, 12, static_cast<std::uint32_t>(blob.size()));
  PutNumber(blob, 16, Crc32(blob.subspan(20)));
}

inline std::vector<std::uint8_t> MakeUpModel(const std::string& name, const std::vector<MadeUpTensor>& tensors) {
  const auto aligned = [](std::size_t n) { return (n + 63) / 64 * 64; };
  std::vector<std::uint8_t> blob(aligned(ModelBlob::kHeaderBytes + tensors.size() * ModelBlob::kEntryBytes));
  std::memcpy(blob.data(), "MWMODEL", 7);
  PutNumber(blob, 8, ModelBlob::kVersion);
  PutNumber(blob, 20, static_cast<std::uint32_t>(tensors.size()));
  std::memcpy(blob.data() + 32, name.data(), name.size());
  for (std::size_t i = 0; i < tensors.size(); ++i) {
    const MadeUpTensor& tensor = tensors[i];
    const std::size_t entry = ModelBlob::kHeaderBytes + i * ModelBlob::kEntryBytes;
    std::memcpy(blob.data() + entry, tensor.name.data(), tensor.name.size());
    PutNumber(blob, entry + 32, static_cast<std::uint32_t>(tensor.type));
    for (std::size_t d = 0; d < 4; ++d) PutNumber(blob, entry + 36 + 4 * d, tensor.shape[d]);
    PutNumber(blob, entry + 52, static_cast<std::uint32_t>(blob.size()));
    PutNumber(blob, entry + 56, static_cast<std::uint32_t>(tensor.bytes.size()));
    blob.insert(blob.end(), tensor.bytes.begin(), tensor.bytes.end());
    blob.resize(aligned(blob.size()));
  }
  RepairHeader(blob);
  return blob;
}

// A copy that starts at a multiple of 64 bytes and ends where its memory ends, so that the address sanitizer sees its
// end.
class AlignedCopy {
 public:
  explicit AlignedCopy(std::span<const std::uint8_t> bytes, std::size_t shift = 0) : memory_(bytes.size() + 128) {
    std::size_t start = 0;
    while (reinterpret_cast<std::uintptr_t>(memory_.data() + start) % ModelBlob::kAlignment != 0) ++start;
    start += shift;
    memory_.resize(start + bytes.size());  // does not move: it only gets smaller
    memory_start_ = start;
    if (!bytes.empty()) std::memcpy(memory_.data() + start, bytes.data(), bytes.size());
  }
  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return std::span(memory_).subspan(memory_start_); }

 private:
  std::vector<std::uint8_t> memory_;
  std::size_t memory_start_ = 0;
};

}  // namespace mapweld::nn
