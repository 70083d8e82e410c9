// SPDX-License-Identifier: Apache-2.0
// First in, first out, fixed capacity. When full, the oldest element makes room and is counted as dropped.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/base/assert.hpp"

namespace mapweld {

template <class T, std::size_t N>
class RingBuffer {
  static_assert(std::is_trivially_destructible_v<T>);

 public:
  static constexpr std::size_t capacity() { return N; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  void clear() { size_ = 0; }

  void Push(const T& value) {
    if (size_ == N) {
      PopFront();
      ++dropped_;
    }
    items_[(first_ + size_) % N] = value;
    ++size_;
  }
  void PopFront() {
    MAPWELD_ASSERT(size_ > 0);
    first_ = (first_ + 1) % N;
    --size_;
  }

  // i = 0 is the oldest.
  T& operator[](std::size_t i) {
    MAPWELD_ASSERT(i < size_);
    return items_[(first_ + i) % N];
  }
  const T& operator[](std::size_t i) const {
    MAPWELD_ASSERT(i < size_);
    return items_[(first_ + i) % N];
  }
  T& front() { return (*this)[0]; }
  const T& front() const { return (*this)[0]; }
  T& back() { return (*this)[size_ - 1]; }
  const T& back() const { return (*this)[size_ - 1]; }

 private:
  std::array<T, N> items_{};
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace mapweld
