// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/time.hpp"

namespace mapweld::executive {

// Work that is due once per period of whatever time it is asked with. Late calls do not pile up.
class RateGroup {
 public:
  explicit RateGroup(DurationNs period) : period_(period) {}

  bool Due(TimeNs now) {
    if (started_ && now >= last_ && now - last_ < period_) return false;
    started_ = true;
    last_ = now;
    return true;
  }
  // Puts the next time off by a whole period.
  void Restart(TimeNs now) {
    started_ = true;
    last_ = now;
  }

 private:
  DurationNs period_;
  TimeNs last_;
  bool started_ = false;
};

}  // namespace mapweld::executive
