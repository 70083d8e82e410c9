// SPDX-License-Identifier: Apache-2.0
// One description per record, used both for writing and for reading: Visit calls the archive with every field in turn.
// Little endian, doubles as their bits.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "core/base/byte_io.hpp"
#include "core/geom/pose3.hpp"
#include "tools/store/database.hpp"

namespace mapweld::store {

class Writer {
 public:
  static constexpr bool kReads = false;
  template <class T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void operator()(const T& value) { Append(&value, sizeof(T)); }
  void operator()(const double& value) { Append(&value, sizeof(value)); }
  void operator()(const float& value) { Append(&value, sizeof(value)); }
  void operator()(const std::string& text) {
    Count(text.size());
    Append(text.data(), text.size());
  }
  void Raw(const void* data, std::size_t bytes) { Append(data, bytes); }
  void Count(std::size_t n) { (*this)(static_cast<std::uint32_t>(n)); }
  Bytes Take() { return std::move(bytes_); }

 private:
  void Append(const void* data, std::size_t n) {
    const auto* from = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), from, from + n);
  }
  Bytes bytes_;
};

class Reader {
 public:
  static constexpr bool kReads = true;
  explicit Reader(std::span<const std::uint8_t> bytes) : reader_(bytes) {}
  template <class T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void operator()(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      const auto byte = reader_.Little<std::uint8_t>();
      value = byte == 1;
      wrong_ = wrong_ || byte > 1;
    } else {
      Raw(&value, sizeof(T));
    }
  }
  void operator()(double& value) { Raw(&value, sizeof(value)); }
  void operator()(float& value) { Raw(&value, sizeof(value)); }
  void operator()(std::string& text) {
    text.resize(Count(1));
    Raw(text.data(), text.size());
  }
  void Raw(void* data, std::size_t n) {
    const auto view = reader_.Bytes(n);
    if (view.size() == n && n > 0) std::memcpy(data, view.data(), n);
  }
  // Never more than the rest of the bytes can hold, so that a wrong count reserves no memory.
  std::size_t Count(std::size_t bytes_each) {
    const std::size_t n = reader_.Little<std::uint32_t>();
    if (n > reader_.remaining() / bytes_each) {
      wrong_ = true;
      return 0;
    }
    return n;
  }
  void Refuse() { wrong_ = true; }
  [[nodiscard]] bool Good() const { return !wrong_ && !reader_.failed() && reader_.remaining() == 0; }

 private:
  ByteReader reader_;
  bool wrong_ = false;
};

// A list with its count in front. bytes_each: the least that one element takes.
template <class Archive, class List, class Field>
void VisitList(Archive& io, List& list, std::size_t bytes_each, const Field& field) {
  if constexpr (Archive::kReads) {
    list.resize(io.Count(bytes_each));
  } else {
    io.Count(list.size());
  }
  for (auto& element : list) field(element);
}

template <class Archive, class Pose>
void VisitPose(Archive& io, Pose& pose) {
  for (int i = 0; i < 3; ++i) io(pose.t[i]);
  for (int i = 0; i < 4; ++i) io(pose.q.coeffs()[i]);
  if constexpr (Archive::kReads) {
    if (!pose.IsValid()) io.Refuse();
  }
}
constexpr std::size_t kPoseBytes = 56;

template <class Archive, class T>
void VisitLoop(Archive& io, T& loop) {
  io(loop.keyframe_a);
  io(loop.keyframe_b);
  VisitPose(io, loop.a_T_b);
  io(loop.overlap_ratio);
  io(loop.residual_m);
  io(loop.weight);
}

template <class Archive, class T>
void VisitOverlap(Archive& io, T& overlap) {
  io(overlap.drive_a);
  io(overlap.drive_b);
  io(overlap.accepted);
  io(overlap.test);
  io(overlap.reverse);
  VisitPose(io, overlap.a_T_b);
  io(overlap.length_m);
  io(overlap.weight);
  VisitList(io, overlap.matches, 8, [&](auto& match) {
    io(match.first);
    io(match.second);
  });
  VisitList(io, overlap.loops, kPoseBytes, [&](auto& loop) { VisitLoop(io, loop); });
}

template <class T, class Visit>
Bytes Write(const T& value, const Visit& visit) {
  Writer writer;
  visit(writer, value);
  return writer.Take();
}

template <class T, class Visit>
bool Read(std::span<const std::uint8_t> bytes, T* out, const Visit& visit) {
  Reader reader(bytes);
  visit(reader, *out);
  return reader.Good();
}

}  // namespace mapweld::store
