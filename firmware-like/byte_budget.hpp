// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/time.hpp"

namespace mapweld::executive {

// A token bucket: over any interval of s seconds at most rate * s + burst bytes are granted.
class ByteBudget {
 public:
  ByteBudget(std::int64_t bytes_per_s, std::int64_t burst_bytes)
      : bytes_per_s_(bytes_per_s), burst_bytes_(burst_bytes), available_(static_cast<double>(burst_bytes)) {}

  // True, and the bytes are spent, when they fit the budget at time now. Times must not decrease.
  bool TrySpend(std::int64_t bytes, TimeNs now) {
    if (started_) {
      const double earned = static_cast<double>(bytes_per_s_) * (now - last_).Seconds();
      available_ = std::min(available_ + std::max(earned, 0.0), static_cast<double>(burst_bytes_));
    }
    started_ = true;
    last_ = now;
    if (available_ < static_cast<double>(bytes)) return false;
    available_ -= static_cast<double>(bytes);
    return true;
  }

 private:
  std::int64_t bytes_per_s_;
  std::int64_t burst_bytes_;
  double available_;
  bool started_ = false;
  TimeNs last_;
};

}  // namespace mapweld::executive
