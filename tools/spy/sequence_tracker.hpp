// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bitset>
#include <cstdint>

namespace mapweld::spy {

// What is missing from the numbers that one sender gives its messages, 1 apart and wrapping at 2^32. A number that
// comes late, within kWindow of the highest, is no longer missing; one that comes twice counts once. A larger step, in
// either direction, is a sender that started anew.
class SequenceTracker {
 public:
  static constexpr std::uint32_t kWindow = 1024;
  static constexpr std::uint32_t kRestart = 1'000'000;

  // false: seen before.
  bool Take(std::uint32_t number) {
    if (!started_ || Distance(number) >= kRestart) {
      started_ = true;
      highest_ = number;
      young_ = kWindow;
      seen_.reset();
      seen_.set(number % kWindow);
      return true;
    }
    const auto ahead = static_cast<std::int32_t>(number - highest_);
    if (ahead > 0) {
      // The places of the numbers skipped over are free again.
      for (std::int32_t i = 1; i <= ahead && i <= static_cast<std::int32_t>(kWindow); ++i) {
        seen_.reset((highest_ + static_cast<std::uint32_t>(i)) % kWindow);
      }
      missing_ += static_cast<std::uint64_t>(ahead) - 1;
      highest_ = number;
      young_ -= std::min(young_, static_cast<std::uint32_t>(ahead));
    } else if (static_cast<std::uint32_t>(-ahead) >= kWindow || seen_.test(number % kWindow)) {
      return false;
    } else if (static_cast<std::uint32_t>(-ahead) < kWindow - young_) {  // not from before the first one heard
      --missing_;
    }
    seen_.set(number % kWindow);
    return true;
  }
  [[nodiscard]] std::uint64_t missing() const { return missing_; }

 private:
  [[nodiscard]] std::uint32_t Distance(std::uint32_t number) const {
    const auto ahead = static_cast<std::int32_t>(number - highest_);
    return ahead < 0 ? 0U - static_cast<std::uint32_t>(ahead) : static_cast<std::uint32_t>(ahead);
  }

  bool started_ = false;
  std::uint32_t highest_ = 0;
  std::uint32_t young_ = 0;  // how much of the window lies before the first one heard
  std::uint64_t missing_ = 0;
  std::bitset<kWindow> seen_;
};

}  // namespace mapweld::spy
