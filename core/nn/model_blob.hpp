// SPDX-License-Identifier: Apache-2.0
// A trained model compiled into the program: one block of bytes with a checksum and a directory of named tensors.
// docs/model_format.md has the layout; tools/train/model_blob.py writes it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include "core/base/status.hpp"

namespace mapweld::nn {

// Unused dimensions are 0: Shape{3, 64} is a matrix.
using Shape = std::array<std::uint32_t, 4>;

enum class TensorType : std::uint32_t { kInt8 = 1, kInt32 = 2, kFloat32 = 3 };

// Why a blob was refused.
enum class BlobFault : std::uint8_t {
  kNone,
  kTooShort,    // fewer bytes than a header
  kMagic,       // not a model
  kVersion,     // a model of another format version
  kSize,        // the header names another size than there is
  kChecksum,    // bytes changed
  kDirectory,   // does not fit, has too many entries, or a reserved field is not zero
  kName,        // empty, not terminated, or the same twice
  kType,        // no such element type
  kShape,       // a gap between dimensions, or a product other than the number of bytes
  kMisaligned,  // the blob or a tensor does not start at a multiple of 64 bytes
  kOverlap,     // tensors out of order, over each other or beyond the end
};
// A few English words; never null.
const char* BlobFaultName(BlobFault fault);

// A view; the bytes must outlive it. A blob that Open() took is safe to read whatever is in it.
class ModelBlob {
 public:
  static constexpr std::uint32_t kVersion = 1;
  static constexpr std::size_t kAlignment = 64;
  static constexpr std::size_t kHeaderBytes = 128;
  static constexpr std::size_t kEntryBytes = 64;
  static constexpr std::size_t kNameBytes = 32;  // of a tensor, with its zero
  static constexpr std::size_t kMaxTensors = 1024;

  // Checks everything; one pass over the bytes for the checksum, tensors * tensors / 2 comparisons of names. On any
  // fault the view stays empty and fault() tells the reason: kVersion (magic or version), kCrc, or kBadInput (all
  // others).
  Status Open(std::span<const std::uint8_t> bytes);

  [[nodiscard]] BlobFault fault() const { return fault_; }
  [[nodiscard]] std::string_view name() const { return name_; }
  [[nodiscard]] std::size_t tensors() const { return tensors_; }

  // The elements of a tensor, row-major. kEmpty: no tensor of that name; kVersion: it has another type or shape, that
  // is, the model is for another network than the program.
  template <class T>
  [[nodiscard]] Result<std::span<const T>> Find(std::string_view name, const Shape& shape) const {
    const Result<std::span<const std::uint8_t>> bytes = FindBytes(name, TypeOf<T>(), shape);
    if (!bytes.ok()) return bytes.status();
    return std::span<const T>(reinterpret_cast<const T*>(bytes.value().data()), bytes.value().size() / sizeof(T));
  }

 private:
  template <class T>
  static constexpr TensorType TypeOf() {
    static_assert(std::is_same_v<T, std::int8_t> || std::is_same_v<T, std::int32_t> || std::is_same_v<T, float>);
    if constexpr (std::is_same_v<T, std::int8_t>) return TensorType::kInt8;
    if constexpr (std::is_same_v<T, std::int32_t>) return TensorType::kInt32;
    return TensorType::kFloat32;
  }
  [[nodiscard]] Result<std::span<const std::uint8_t>> FindBytes(std::string_view name, TensorType type,
                                                                const Shape& shape) const;
  std::span<const std::uint8_t> bytes_;
  std::string_view name_;
  std::size_t tensors_ = 0;
  BlobFault fault_ = BlobFault::kNone;
};

}  // namespace mapweld::nn
