// SPDX-License-Identifier: Apache-2.0
// Adaptive binary range coder: each bit costs its information under a running estimate of its probability.
// Formulas: the coder of LZMA (Pavlov, "LZMA specification", 2015, section "Range decoder"; carry as in Martin, "Range
// encoding", 1979), with 12-bit probabilities that move by 1/32 per bit.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace mapweld::submap {

// The probability that a bit is 0, in 1/4096, learnt from the bits that it coded.
class BitModel {
 public:
  static constexpr unsigned kBits = 12;

  [[nodiscard]] std::uint32_t zero() const { return zero_; }
  void Learn(bool bit) {
    if (bit) {
      zero_ = static_cast<std::uint16_t>(zero_ - (zero_ >> kSpeed));
    } else {
      zero_ = static_cast<std::uint16_t>(zero_ + (((1U << kBits) - zero_) >> kSpeed));
    }
  }

 private:
  static constexpr unsigned kSpeed = 5;
  std::uint16_t zero_ = 1U << (kBits - 1);
};

// Writes into `out`; failed() when it was too small. Constant cost per bit.
class RangeEncoder {
 public:
  explicit RangeEncoder(std::span<std::uint8_t> out) : out_(out) {}

  void Put(bool bit, BitModel* model) {
    const std::uint32_t bound = (range_ >> BitModel::kBits) * model->zero();
    if (bit) {
      low_ += bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    model->Learn(bit);
    while (range_ < kTop) {
      range_ <<= 8U;
      ShiftOut();
    }
  }
  // `bits` (at most 8) bits of value that are as good as random, in one step.
  void PutEven(std::uint32_t value, unsigned bits) {
    range_ >>= bits;
    low_ += static_cast<std::uint64_t>(value) * range_;
    while (range_ < kTop) {
      range_ <<= 8U;
      ShiftOut();
    }
  }
  // Ends the stream and gives its length.
  std::size_t Finish() {
    for (int i = 0; i < 5; ++i) ShiftOut();
    return size_;
  }
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  static constexpr std::uint32_t kTop = 1U << 24U;

  // Bytes of 0xFF wait until it is known whether a carry will run through them.
  void ShiftOut() {
    if (low_ < 0xFF000000U || low_ > 0xFFFFFFFFU) {
      const auto carry = static_cast<std::uint8_t>(low_ >> 32U);
      for (; waiting_ > 0; --waiting_) {
        Write(static_cast<std::uint8_t>(cache_ + carry));
        cache_ = 0xFF;
      }
      cache_ = static_cast<std::uint8_t>(low_ >> 24U);
    }
    ++waiting_;
    low_ = (low_ & 0x00FFFFFFU) << 8U;
  }
  void Write(std::uint8_t byte) {
    if (size_ == out_.size()) {
      failed_ = true;
      return;
    }
    out_[size_++] = byte;
  }

  std::span<std::uint8_t> out_;
  std::size_t size_ = 0;
  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFU;
  std::uint8_t cache_ = 0;
  std::uint64_t waiting_ = 1;  // the first byte is always 0
  bool failed_ = false;
};

// Reads what RangeEncoder wrote. Any bytes decode to some bits; failed() when they ran out.
class RangeDecoder {
 public:
  explicit RangeDecoder(std::span<const std::uint8_t> in) : in_(in) {
    for (int i = 0; i < 5; ++i) code_ = (code_ << 8U) | Read();
  }

  bool Get(BitModel* model) {
    const std::uint32_t bound = (range_ >> BitModel::kBits) * model->zero();
    const bool bit = code_ >= bound;
    if (bit) {
      code_ -= bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    model->Learn(bit);
    while (range_ < kTop) {
      range_ <<= 8U;
      code_ = (code_ << 8U) | Read();
    }
    return bit;
  }
  std::uint32_t GetEven(unsigned bits) {
    range_ >>= bits;
    const std::uint32_t value = std::min(code_ / range_, (1U << bits) - 1);
    code_ -= value * range_;
    while (range_ < kTop) {
      range_ <<= 8U;
      code_ = (code_ << 8U) | Read();
    }
    return value;
  }
  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] std::size_t read() const { return at_; }

 private:
  static constexpr std::uint32_t kTop = 1U << 24U;

  std::uint8_t Read() {
    if (at_ == in_.size()) {
      failed_ = true;
      return 0;
    }
    return in_[at_++];
  }

  std::span<const std::uint8_t> in_;
  std::size_t at_ = 0;
  std::uint32_t code_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFU;
  bool failed_ = false;
};

}  // namespace mapweld::submap
