// SPDX-License-Identifier: Apache-2.0
// Named scalars at fixed offsets in a record: what PCD and PLY have in common.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace mapweld::io {

enum class Scalar { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat, kDouble };
std::size_t ScalarBytes(Scalar type);
// The scalar at `at` (little-endian, any alignment).
double ReadScalar(const char* at, Scalar type);

struct RecordField {
  std::string name;
  Scalar type = Scalar::kFloat;
  std::size_t count = 1;   // scalars in the field; only the first is read
  std::size_t offset = 0;  // bytes from the start of a binary record
  std::size_t word = 0;    // words from the start of a text record
};

class RecordLayout {
 public:
  // Fields follow one another without gaps, in the order of the calls.
  void Add(std::string name, Scalar type, std::size_t count);
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  [[nodiscard]] std::size_t words() const { return words_; }
  [[nodiscard]] const std::vector<RecordField>& fields() const { return fields_; }
  // Null when there is no such field. The pointer lives until the next Add.
  [[nodiscard]] const RecordField* Find(std::string_view name) const;

 private:
  std::vector<RecordField> fields_;
  std::size_t bytes_ = 0;
  std::size_t words_ = 0;
};

}  // namespace mapweld::io
