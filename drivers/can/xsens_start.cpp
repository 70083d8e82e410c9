// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/xsens_start.hpp"

#include <algorithm>

namespace mapweld::can {
namespace {

// The square of the length, exact.
std::int64_t Squared(const std::array<std::int16_t, 3>& axes) {
  std::int64_t sum = 0;
  for (const std::int64_t axis : axes) sum += axis * axis;
  return sum;
}

bool IsGravity(const std::array<std::int16_t, 3>& axes) {
  constexpr std::int64_t kLeast = XsensStart::kLeastGravityLsb;
  constexpr std::int64_t kMost = XsensStart::kMostGravityLsb;
  return Squared(axes) >= kLeast * kLeast && Squared(axes) <= kMost * kMost;
}

}  // namespace

InertialOrder XsensStart::OrderOf(const XsensGroup& group) const {
  if (order_ != InertialOrder::kDetect) return order_;
  constexpr std::int64_t kTurn = std::int64_t{kLeastGravityLsb} * kLeastGravityLsb;
  if (IsGravity(group.accel) && Squared(group.gyro) < kTurn) return InertialOrder::kAsNamed;
  if (IsGravity(group.gyro) && Squared(group.accel) < kTurn) return InertialOrder::kSwapped;
  return InertialOrder::kDetect;
}

// Whether the group follows the last one, with a step like the one before.
bool XsensStart::Continues(const XsensGroup& group, std::uint32_t step) const {
  if (agreeing_ < 0 || static_cast<std::uint16_t>(group.counter - last_.counter) != 1) return false;
  if (step == 0 || step > 0x4000'0000) return false;
  return agreeing_ == 0 || (step <= 2 * step_ && step_ <= 2 * step);
}

// Of the run from first_ to last_; kDetect when the stamps do not tell yet.
SampleTimeUnit XsensStart::Conclude() const {
  if (unit_ != SampleTimeUnit::kDetect) return unit_;
  const std::uint32_t run = last_.sample_time_ticks - first_.sample_time_ticks;
  if (run > kGroups * kMost100usTicks) return SampleTimeUnit::k1us;
  if (run <= kGroups * kSure100usTicks || !stamped_) return SampleTimeUnit::k100us;
  if (!first_.stamped || !last_.stamped) return SampleTimeUnit::kDetect;  // stamps are there, but not where it matters
  const std::int64_t elapsed_ns = (last_.first_receive - first_.first_receive).ns;
  // Within a factor of 3; the units differ by one of 100.
  const auto fits = [&](std::int64_t tick_ns) {
    return 3 * elapsed_ns >= run * tick_ns && elapsed_ns <= 3 * run * tick_ns;
  };
  if (fits(100'000)) return SampleTimeUnit::k100us;
  return fits(1'000) ? SampleTimeUnit::k1us : SampleTimeUnit::kDetect;
}

bool XsensStart::Push(const XsensGroup& group) {
  if (unit_ != SampleTimeUnit::kDetect && order_ != InertialOrder::kDetect) return true;
  const InertialOrder order = OrderOf(group);
  const std::uint32_t step = group.sample_time_ticks - last_.sample_time_ticks;
  const bool agrees = order != InertialOrder::kDetect && Continues(group, step) && order == OrderOf(last_);
  agreeing_ = agrees ? agreeing_ + 1 : 0;
  if (!agrees) first_ = group;
  stamped_ = group.stamped || (agrees && stamped_);
  step_ = step;
  last_ = group;
  if (agreeing_ < kGroups) return false;
  const SampleTimeUnit unit = Conclude();
  if (unit == SampleTimeUnit::kDetect) {  // the stamps do not make sense yet
    agreeing_ = 0;
    first_ = group;
    return false;
  }
  unit_ = unit;
  order_ = order;
  return true;
}

}  // namespace mapweld::can
