// SPDX-License-Identifier: Apache-2.0
// A vector with its storage inside: at most N elements, no heap. Elements are never destroyed, only
// overwritten, so T must be trivially destructible. Copies cost size(), not N.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <type_traits>

#include "core/base/assert.hpp"
#include "core/base/status.hpp"

namespace mapweld {

template <class T, std::size_t N>
class FixedVector {
  static_assert(std::is_trivially_destructible_v<T>);

 public:
  FixedVector() = default;
  FixedVector(const FixedVector& other) { *this = other; }
  FixedVector& operator=(const FixedVector& other) {
    if (this == &other) return *this;
    std::copy(other.begin(), other.end(), items_.begin());
    size_ = other.size_;
    return *this;
  }

  static constexpr std::size_t capacity() { return N; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] bool full() const { return size_ == N; }
  void clear() { size_ = 0; }

  // kFull leaves the vector as it was: the newcomer is dropped and the caller counts it.
  Status TryPush(const T& value) {
    if (full()) return Status::kFull;
    items_[size_++] = value;
    return Status::kOk;
  }
  void resize(std::size_t size) {
    MAPWELD_ASSERT(size <= N);
    size_ = size;
  }

  T& operator[](std::size_t i) {
    MAPWELD_ASSERT(i < size_);
    return items_[i];
  }
  const T& operator[](std::size_t i) const {
    MAPWELD_ASSERT(i < size_);
    return items_[i];
  }
  T& back() { return (*this)[size_ - 1]; }
  const T& back() const { return (*this)[size_ - 1]; }
  T* data() { return items_.data(); }
  const T* data() const { return items_.data(); }
  T* begin() { return items_.data(); }
  T* end() { return items_.data() + size_; }
  const T* begin() const { return items_.data(); }
  const T* end() const { return items_.data() + size_; }
  std::span<T> span() { return {items_.data(), size_}; }
  [[nodiscard]] std::span<const T> span() const { return {items_.data(), size_}; }

 private:
  std::array<T, N> items_;
  std::size_t size_ = 0;
};

}  // namespace mapweld
