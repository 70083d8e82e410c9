// SPDX-License-Identifier: Apache-2.0
#include "drivers/time/sensor_clock.hpp"

#include <algorithm>

namespace mapweld::time {
namespace {

constexpr DurationNs Abs(DurationNs d) {
  return d.ns < 0 ? DurationNs{-d.ns} : d;
}

}  // namespace

// The signed way from one reading to another, at most half a turn of the counter.
DurationNs SensorClock::Step(std::uint64_t from_ticks, std::uint64_t to_ticks) const {
  const std::uint64_t wrap = options_.wrap_ticks;
  const std::uint64_t forward = (to_ticks + wrap - from_ticks) % wrap;
  const auto signed_ticks = forward <= wrap / 2 ? static_cast<std::int64_t>(forward)
                                                : static_cast<std::int64_t>(forward) - static_cast<std::int64_t>(wrap);
  return {signed_ticks * options_.tick_ns};
}

// The time congruent to `ticks` that lies nearest to `to`.
TimeNs SensorClock::Nearest(std::uint64_t ticks, TimeNs to) const {
  const std::int64_t turn = static_cast<std::int64_t>(options_.wrap_ticks) * options_.tick_ns;
  const std::int64_t phase = static_cast<std::int64_t>(ticks) * options_.tick_ns;
  const std::int64_t turns = (to.ns - phase + turn / 2) / turn;
  return {std::max<std::int64_t>(turns, 0) * turn + phase};
}

void SensorClock::Start(std::uint64_t ticks, TimeNs receive) {
  const TimeNs before = sensor_ + offset_;
  const DurationNs silence = std::clamp(receive - last_receive_, DurationNs{0}, kLongestSilence);
  sensor_ = {static_cast<std::int64_t>(ticks) * options_.tick_ns};
  if (options_.mode == ClockMode::kReceive) {
    // After a restart of the sensor time goes on from where it was, even if the receive stamp was early.
    offset_ = started_ ? std::max(receive, before) - sensor_ : receive - sensor_;
  } else if (!started_) {
    if (anchored_) sensor_ = Nearest(ticks, anchor_);
  } else {
    // The sensor may still be synchronised, with another turn count; if no turn fits, bridge by the receive clock.
    const TimeNs target = anchored_ ? anchor_ : before + silence;
    const TimeNs congruent = Nearest(ticks, target - offset_);
    if (Abs(congruent + offset_ - target) <= kJump) {
      sensor_ = congruent;
    } else {
      offset_ = target - sensor_;
    }
  }
  settled_ = {0};
  started_ = true;
  candidates_ = 0;
}

bool SensorClock::AgreesWithCandidate(std::uint64_t ticks, TimeNs receive) {
  const DurationNs step = Step(candidate_ticks_, ticks);
  bool agrees = candidates_ > 0 && step >= DurationNs{0} && step < kJump;
  if (options_.mode == ClockMode::kReceive) {
    agrees = agrees && Abs({step.ns - (receive - candidate_receive_).ns}) < kJump;
  }
  candidates_ = agrees ? candidates_ + 1 : 1;
  candidate_ticks_ = ticks;
  candidate_receive_ = receive;
  return candidates_ >= kResyncSamples;
}

void SensorClock::MoveEnvelope(DurationNs since_last, TimeNs receive) {
  const DurationNs error{(receive - sensor_).ns - offset_.ns};
  // After a silence of days the offset moves as after one of an hour; this also keeps the product below within 64 bits.
  const DurationNs elapsed = std::clamp(since_last, DurationNs{0}, Milliseconds(3'600'000));
  const std::int64_t slew = elapsed.ns * kSlewPpm / 1'000'000 + 1;
  const bool settling = settled_ < kSettle;
  settled_.ns = std::min(settled_.ns + elapsed.ns, kSettle.ns);
  if (error < DurationNs{0}) {
    // A fall during settling is limited to the sensor's own step, so that the mapped time still does not go back.
    const std::int64_t limit = settling ? elapsed.ns : slew;
    offset_.ns -= std::min(-error.ns, limit);
  } else {
    offset_.ns += std::min(error.ns, slew);
  }
}

Status SensorClock::ToTime(std::uint64_t ticks, TimeNs receive, TimeNs* out) {
  if (ticks >= options_.wrap_ticks) {
    ++counters_.out_of_range;
    return Status::kOutOfRange;
  }
  if (!started_) {
    Start(ticks, receive);
  } else {
    DurationNs step = Step(last_ticks_, ticks);
    bool jump = step < DurationNs{-kJump.ns};
    if (options_.mode == ClockMode::kReceive) {
      // The receive clock tells how many turns passed during a long silence.
      const std::int64_t turn = static_cast<std::int64_t>(options_.wrap_ticks) * options_.tick_ns;
      const DurationNs expected = receive - last_receive_;
      const std::int64_t missing = expected.ns - step.ns;
      step.ns += (missing >= 0 ? (missing + turn / 2) / turn : -((-missing + turn / 2) / turn)) * turn;
      jump = Abs({expected.ns - step.ns}) > kJump || step < DurationNs{-kJump.ns} || step > kLongestSilence;
    }
    if (jump) {
      ++counters_.jumps;
      if (!AgreesWithCandidate(ticks, receive)) return Status::kStale;
      ++counters_.resyncs;
      Start(ticks, receive);
    } else {
      candidates_ = 0;
      sensor_ = sensor_ + step;
      if (options_.mode == ClockMode::kReceive) MoveEnvelope(step, receive);
    }
  }
  last_ticks_ = ticks;
  last_receive_ = receive;
  ++counters_.accepted;
  *out = sensor_ + offset_;
  return Status::kOk;
}

}  // namespace mapweld::time
