// SPDX-License-Identifier: Apache-2.0
#include "tools/io/record_layout.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace mapweld::io {
namespace {

template <class T>
double Read(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return static_cast<double>(value);
}

}  // namespace

std::size_t ScalarBytes(Scalar type) {
  switch (type) {
    case Scalar::kInt8:
    case Scalar::kUint8:
      return 1;
    case Scalar::kInt16:
    case Scalar::kUint16:
      return 2;
    case Scalar::kInt32:
    case Scalar::kUint32:
    case Scalar::kFloat:
      return 4;
    case Scalar::kInt64:
    case Scalar::kUint64:
    case Scalar::kDouble:
      return 8;
  }
  return 0;
}

double ReadScalar(const char* at, Scalar type) {
  switch (type) {
    case Scalar::kInt8:
      return Read<std::int8_t>(at);
    case Scalar::kUint8:
      return Read<std::uint8_t>(at);
    case Scalar::kInt16:
      return Read<std::int16_t>(at);
    case Scalar::kUint16:
      return Read<std::uint16_t>(at);
    case Scalar::kInt32:
      return Read<std::int32_t>(at);
    case Scalar::kUint32:
      return Read<std::uint32_t>(at);
    case Scalar::kInt64:
      return Read<std::int64_t>(at);
    case Scalar::kUint64:
      return Read<std::uint64_t>(at);
    case Scalar::kFloat:
      return Read<float>(at);
    case Scalar::kDouble:
      return Read<double>(at);
  }
  return 0;
}

void RecordLayout::Add(std::string name, Scalar type, std::size_t count) {
  fields_.push_back({std::move(name), type, count, bytes_, words_});
  bytes_ += ScalarBytes(type) * count;
  words_ += count;
}

const RecordField* RecordLayout::Find(std::string_view name) const {
  const auto it = std::find_if(fields_.begin(), fields_.end(), [&](const RecordField& f) { return f.name == name; });
  return it == fields_.end() ? nullptr : &*it;
}

}  // namespace mapweld::io
