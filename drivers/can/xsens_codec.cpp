// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/xsens_codec.hpp"

#include <cmath>
#include <span>
#include <utility>

#include "core/base/byte_io.hpp"
#include "drivers/can/xsens_table.hpp"

namespace mapweld::can {
namespace {

constexpr double kGyroLsb = 1.0 / 512.0;   // rad/s
constexpr double kAccelLsb = 1.0 / 256.0;  // m/s^2

constexpr time::SensorClockOptions ClockFor(SampleTimeUnit unit, time::ClockMode mode) {
  time::SensorClockOptions clock = unit == SampleTimeUnit::k1us ? time::kXsens1usClock : time::kXsens100usClock;
  clock.mode = mode;
  return clock;
}

std::uint8_t PartOf(XsensField field) {
  switch (field) {
    case XsensField::kSampleTime:
      return XsensGroup::kTime;
    case XsensField::kGroupCounter:
      return XsensGroup::kCounter;
    case XsensField::kStatusWord:
      return XsensGroup::kStatus;
    case XsensField::kRateOfTurn:
      return XsensGroup::kGyro;
    case XsensField::kAcceleration:
      return XsensGroup::kAccel;
    case XsensField::kNone:
      break;
  }
  return 0;
}

// false when an axis is outside +-limit.
bool ReadAxes(ByteReader* reader, double lsb, double limit, std::array<std::int16_t, 3>* axes) {
  bool inside = true;
  for (std::int16_t& axis : *axes) {
    axis = reader->Big<std::int16_t>();
    inside = inside && std::abs(axis * lsb) <= limit;
  }
  return inside;
}

Eigen::Vector3d Scaled(const std::array<std::int16_t, 3>& axes, double lsb) {
  return {axes[0] * lsb, axes[1] * lsb, axes[2] * lsb};
}

}  // namespace

XsensCodec::XsensCodec(const XsensOptions& options)
    : options_(options),
      start_(options.sample_time_unit, options.inertial_order),
      tick_ns_(ClockFor(options.sample_time_unit, options.clock_mode).tick_ns),
      clock_(ClockFor(options.sample_time_unit, options.clock_mode)) {
  group_.done = true;  // until a SampleTime opens one
}

std::uint64_t XsensCodec::Rejected() const {
  const Counters& c = counters_;
  return c.error_frames + c.remote + c.extended + c.unknown_id + c.wrong_dlc + c.out_of_range + c.no_group +
         c.torn_groups + c.stale;
}

Status XsensCodec::Check(const CanFrame& frame) {
  std::uint64_t* cause = nullptr;
  const XsensField field = options_.ids.FieldOf(frame);
  const XsensMessage* message = frame.extended ? nullptr : FindXsensMessage(frame.id);
  const bool wanted = field != XsensField::kNone;
  if (frame.error) {
    cause = &counters_.error_frames;
  } else if (frame.extended && !wanted) {
    cause = &counters_.extended;
  } else if (frame.remote) {
    cause = &counters_.remote;
  } else if (!wanted && message == nullptr) {
    cause = &counters_.unknown_id;
  } else if (frame.dlc != (wanted ? DlcOf(field) : message->dlc)) {
    cause = &counters_.wrong_dlc;
  }
  if (cause != nullptr) {
    ++*cause;
    return Status::kBadInput;
  }
  if (wanted) return Status::kOk;
  ++counters_.unused;
  return Status::kEmpty;
}

// What the frame holds, as far as that is known.
XsensField XsensCodec::FieldOf(const CanFrame& frame) const {
  const XsensField field = options_.ids.FieldOf(frame);
  if (!start_.swapped()) return field;
  if (field == XsensField::kRateOfTurn) return XsensField::kAcceleration;
  return field == XsensField::kAcceleration ? XsensField::kRateOfTurn : field;
}

void XsensCodec::Tear() {
  if (!group_.done || held_) ++counters_.torn_groups;
  group_.done = true;
  held_ = false;
}

Status XsensCodec::Store(const CanFrame& frame) {
  const XsensField field = FieldOf(frame);
  const std::uint8_t part = PartOf(field);
  if (field == XsensField::kSampleTime) {
    Tear();  // what is still open did not complete
    group_ = {};
    group_.first_receive = frame.receive;
  } else if (group_.done && (group_.parts & part) == 0 && part == XsensGroup::kStatus) {
    return Status::kNotReady;  // a StatusWord after the sample: nothing left to mark
  } else if (group_.done) {
    ++counters_.no_group;
    return Status::kBadInput;
  } else if ((group_.parts & part) != 0) {
    Tear();
    return Status::kBadInput;
  }
  group_.parts = static_cast<std::uint8_t>(group_.parts | part);
  group_.last_receive = frame.receive;
  group_.stamped = group_.stamped && frame.stamped;

  ByteReader reader(std::span(frame.data).first(frame.dlc));
  bool inside = true;
  if (field == XsensField::kSampleTime) group_.sample_time_ticks = reader.Big<std::uint32_t>();
  if (field == XsensField::kGroupCounter) group_.counter = reader.Big<std::uint16_t>();
  if (field == XsensField::kStatusWord) group_.status = reader.Big<std::uint32_t>();
  if (field == XsensField::kRateOfTurn) inside = ReadAxes(&reader, kGyroLsb, kMaxGyroRadS, &group_.gyro);
  if (field == XsensField::kAcceleration) inside = ReadAxes(&reader, kAccelLsb, kMaxAccelMs2, &group_.accel);
  if (inside) return Status::kOk;
  ++counters_.out_of_range;
  group_.done = true;  // counted by its cause, not as torn
  return Status::kOutOfRange;
}

void XsensCodec::UseUnit() {
  started_ = true;
  const time::SensorClockOptions clock = ClockFor(start_.unit(), options_.clock_mode);
  tick_ns_ = clock.tick_ns;
  if (options_.sample_time_unit == SampleTimeUnit::kDetect) clock_ = time::SensorClock(clock);
}

Status XsensCodec::Finish(sensor::ImuSample* sample) {
  if (!started_) {
    if (!start_.Push(group_)) {
      group_.done = true;
      ++counters_.undecided;
      return Status::kNotReady;
    }
    UseUnit();
    const bool stored_as_named = options_.inertial_order == InertialOrder::kDetect;
    if (start_.swapped() && stored_as_named) std::swap(group_.gyro, group_.accel);
  }
  const XsensContinuity::Verdict verdict = continuity_.Judge(group_, tick_ns_);
  if (verdict == XsensContinuity::Verdict::kTorn) {
    Tear();
    return Status::kBadInput;
  }
  group_.done = true;
  held_ = verdict == XsensContinuity::Verdict::kLate;
  return held_ ? Status::kNotReady : Emit(sample);
}

// `frame`: the SampleTime of the next group.
Status XsensCodec::ReleaseHeld(const CanFrame& frame, sensor::ImuSample* sample) {
  const auto ticks = ByteReader(std::span(frame.data).first(frame.dlc)).Big<std::uint32_t>();
  if (!held_ || !continuity_.FollowsDirectly(ticks)) return Status::kNotReady;  // Store tears what is held
  held_ = false;
  return Emit(sample);
}

Status XsensCodec::Emit(sensor::ImuSample* sample) {
  TimeNs t;
  const Status status = clock_.ToTime(group_.sample_time_ticks, group_.first_receive, &t);
  if (status != Status::kOk || (emitted_ && t <= last_t_)) {
    ++counters_.stale;
    return Status::kStale;
  }
  emitted_ = true;
  last_t_ = t;
  sample->t = t;
  sample->gyro_body = Scaled(group_.gyro, kGyroLsb);
  sample->accel_body = Scaled(group_.accel, kAccelLsb);
  sample->clipped = (group_.status & kXsensClippingBits) != 0;
  ++counters_.samples;
  if (sample->clipped) ++counters_.clipped;
  return Status::kOk;
}

Status XsensCodec::Push(const CanFrame& frame, sensor::ImuSample* sample) {
  ++counters_.frames;
  if (frame.gap) Tear();
  if (const Status status = Check(frame); status != Status::kOk) return status;
  Status released = Status::kNotReady;
  if (options_.ids.FieldOf(frame) == XsensField::kSampleTime) released = ReleaseHeld(frame, sample);
  if (const Status status = Store(frame); status != Status::kOk) return status;
  if ((group_.parts & XsensGroup::kNeeded) != XsensGroup::kNeeded) return released;
  return Finish(sample);
}

}  // namespace mapweld::can
