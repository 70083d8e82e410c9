// SPDX-License-Identifier: Apache-2.0
// Bounds-checked reading and writing of integers in a byte span. A read past the end gives zero and sets failed(), so a
// decoder reads a whole header and asks once.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace mapweld {

template <std::integral T>
constexpr T ByteSwap(T value) {
  auto u = static_cast<std::make_unsigned_t<T>>(value);
  std::make_unsigned_t<T> out = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    // Shifted in 64 bits, because shifting 8 bits by 8 would not be defined.
    out = static_cast<std::make_unsigned_t<T>>((std::uint64_t{out} << 8U) | (u & 0xFFU));
    u = static_cast<std::make_unsigned_t<T>>(std::uint64_t{u} >> 8U);
  }
  return static_cast<T>(out);
}

static_assert(std::endian::native == std::endian::little, "mapweld supports little-endian machines only");

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <std::integral T>
  T Little() {
    T value = 0;
    if (!Take(&value, sizeof(T))) return 0;
    return value;
  }
  template <std::integral T>
  T Big() {
    return ByteSwap(Little<T>());
  }
  // The next n bytes as a view; empty and failed() when fewer are left.
  std::span<const std::uint8_t> Bytes(std::size_t n) {
    if (n > remaining()) {
      failed_ = true;
      return {};
    }
    auto view = bytes_.subspan(at_, n);
    at_ += n;
    return view;
  }
  void Skip(std::size_t n) { (void)Bytes(n); }
  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - at_; }
  [[nodiscard]] std::size_t position() const { return at_; }
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  bool Take(void* out, std::size_t n) {
    auto view = Bytes(n);
    if (view.size() != n) return false;
    std::memcpy(out, view.data(), n);
    return true;
  }
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

class ByteWriter {
 public:
  explicit ByteWriter(std::span<std::uint8_t> bytes) : bytes_(bytes) {}

  template <std::integral T>
  void Little(T value) {
    Put(&value, sizeof(T));
  }
  template <std::integral T>
  void Big(T value) {
    Little(ByteSwap(value));
  }
  void Bytes(std::span<const std::uint8_t> bytes) { Put(bytes.data(), bytes.size()); }
  [[nodiscard]] std::size_t size() const { return at_; }
  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] std::span<const std::uint8_t> written() const { return bytes_.first(at_); }

 private:
  void Put(const void* from, std::size_t n) {
    if (n > bytes_.size() - at_) {
      failed_ = true;
      return;
    }
    if (n != 0) std::memcpy(bytes_.data() + at_, from, n);
    at_ += n;
  }
  std::span<std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

}  // namespace mapweld
