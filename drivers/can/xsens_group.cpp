// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/xsens_group.hpp"

#include <cstdlib>

namespace mapweld::can {

bool XsensContinuity::Consistent(const XsensGroup& group, std::int64_t tick_ns) {
  if (!started_) return true;
  const std::int64_t groups = static_cast<std::uint16_t>(group.counter - last_counter_);
  const std::int64_t ticks = static_cast<std::int32_t>(group.sample_time_ticks - last_ticks_);
  if (groups == 0 || ticks <= 0) return false;
  if (period_ticks_ != 0) {
    // Half a period tells one group from the next; the tenth leaves room for a rounded period over a long gap.
    const std::int64_t expected = groups * period_ticks_;
    if (std::llabs(ticks - expected) > period_ticks_ / 2 + expected / 10) return false;
    if (group.stamped && (group.last_receive - group.first_receive).ns > period_ticks_ * tick_ns) return false;
  }
  if (groups == 1 || period_ticks_ == 0) period_ticks_ = ticks / groups;
  return true;
}

bool XsensContinuity::Accept(const XsensGroup& group, std::int64_t tick_ns) {
  if (!Consistent(group, tick_ns)) {
    if (++contradictions_ < kRelearnAfter) return false;
    period_ticks_ = 0;
  }
  contradictions_ = 0;
  started_ = true;
  last_ticks_ = group.sample_time_ticks;
  last_counter_ = group.counter;
  return true;
}

}  // namespace mapweld::can
