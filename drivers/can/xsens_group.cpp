// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/xsens_group.hpp"

#include <cstdlib>

namespace mapweld::can {

bool XsensContinuity::Consistent(const XsensGroup& group) {
  if (!started_) return true;
  const std::int64_t groups = static_cast<std::uint16_t>(group.counter - last_counter_);
  const std::int64_t ticks = static_cast<std::int32_t>(group.sample_time_ticks - last_ticks_);
  if (groups == 0 || ticks <= 0) return false;
  if (period_ticks_ != 0) {
    // Half a period tells one group from the next; the tenth leaves room for a rounded period over a long gap.
    const std::int64_t expected = groups * period_ticks_;
    if (std::llabs(ticks - expected) > period_ticks_ / 2 + expected / 10) return false;
  }
  if (groups == 1 || period_ticks_ == 0) period_ticks_ = ticks / groups;
  return true;
}

XsensContinuity::Verdict XsensContinuity::Judge(const XsensGroup& group, std::int64_t tick_ns) {
  if (!Consistent(group)) {
    if (++contradictions_ < kRelearnAfter) return Verdict::kTorn;
    period_ticks_ = 0;
  }
  contradictions_ = 0;
  started_ = true;
  last_ticks_ = group.sample_time_ticks;
  last_counter_ = group.counter;
  const std::int64_t span_ns = (group.last_receive - group.first_receive).ns;
  const bool late = group.stamped && period_ticks_ != 0 && span_ns > period_ticks_ * tick_ns;
  return late ? Verdict::kLate : Verdict::kGood;
}

bool XsensContinuity::FollowsDirectly(std::uint32_t sample_time_ticks) const {
  const std::int64_t ticks = static_cast<std::int32_t>(sample_time_ticks - last_ticks_);
  return ticks > 0 && 2 * ticks < 3 * period_ticks_;
}

}  // namespace mapweld::can
