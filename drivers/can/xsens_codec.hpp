// SPDX-License-Identifier: Apache-2.0
// Builds IMU samples from the CAN frames of an Xsens MTi (600 series or newer). The device's axes are x forward, y
// left, z up: the body frame. Frames are small and self-contained; the cost is constant per frame. Needed messages:
// SampleTime, GroupCounter, RateOfTurn, Acceleration; StatusWord (clipping) when it is sent.
#pragma once

#include <cstdint>

#include "core/base/status.hpp"
#include "core/sensor/imu_sample.hpp"
#include "drivers/can/can_frame.hpp"
#include "drivers/can/xsens_group.hpp"
#include "drivers/can/xsens_ids.hpp"
#include "drivers/can/xsens_start.hpp"
#include "drivers/time/sensor_clock.hpp"

namespace mapweld::can {

struct XsensOptions {
  XsensIds ids{};
  SampleTimeUnit sample_time_unit = SampleTimeUnit::k100us;
  InertialOrder inertial_order = InertialOrder::kAsNamed;
  time::ClockMode clock_mode = time::ClockMode::kShared;
};

class XsensCodec {
 public:
  // The sensor measures 2000 deg/s and 10 g; what lies outside is a fault, not a motion.
  static constexpr double kMaxGyroRadS = 35.0;
  static constexpr double kMaxAccelMs2 = 100.0;
  static constexpr int kDetectGroups = XsensStart::kGroups;  // that give no sample, when something is to be detected

  struct Counters {
    std::uint64_t frames = 0;
    std::uint64_t samples = 0;
    std::uint64_t clipped = 0;    // samples, delivered and marked
    std::uint64_t undecided = 0;  // samples before unit and order were known
    std::uint64_t unused = 0;     // known messages that odometry does not need
    // refused frames
    std::uint64_t error_frames = 0;
    std::uint64_t remote = 0;
    std::uint64_t extended = 0;
    std::uint64_t unknown_id = 0;
    std::uint64_t wrong_dlc = 0;
    std::uint64_t out_of_range = 0;  // a physical value no MTi can measure
    std::uint64_t no_group = 0;      // data before a SampleTime opened a group
    // refused samples
    std::uint64_t torn_groups = 0;  // frames of two groups, or frames missing
    std::uint64_t stale = 0;        // time went backwards
  };

  explicit XsensCodec(const XsensOptions& options);

  // kOk: *sample is a new sample; of a group that the bus delayed it comes with the SampleTime of the next. kNotReady:
  // the frame was used, the sample is not complete. kEmpty: a known message that is not needed. Everything else is a
  // refusal, counted by cause; *sample is then unchanged.
  Status Push(const CanFrame& frame, sensor::ImuSample* sample);

  [[nodiscard]] const Counters& counters() const { return counters_; }
  // What was told or concluded: see XsensStart.
  [[nodiscard]] const XsensStart& start() const { return start_; }
  // Frames and samples refused, all causes together.
  [[nodiscard]] std::uint64_t Rejected() const;
  time::SensorClock& clock() { return clock_; }
  [[nodiscard]] const time::SensorClock& clock() const { return clock_; }

 private:
  Status Check(const CanFrame& frame);
  [[nodiscard]] XsensField FieldOf(const CanFrame& frame) const;
  Status Store(const CanFrame& frame);
  Status Finish(sensor::ImuSample* sample);
  Status Emit(sensor::ImuSample* sample);
  Status ReleaseHeld(const CanFrame& frame, sensor::ImuSample* sample);
  void Tear();
  void UseUnit();

  XsensOptions options_;
  XsensStart start_;
  bool started_ = false;  // nothing is left to detect
  std::int64_t tick_ns_;
  time::SensorClock clock_;
  XsensGroup group_;
  XsensContinuity continuity_;
  bool held_ = false;  // group_ is complete but late: see XsensContinuity
  bool emitted_ = false;
  TimeNs last_t_;
  Counters counters_;
};

}  // namespace mapweld::can
