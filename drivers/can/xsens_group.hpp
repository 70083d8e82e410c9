// SPDX-License-Identifier: Apache-2.0
// Collects the frames of one Xsens sample. Only the GroupCounter frame carries the group's number, so which data
// belongs to it has to be concluded: SampleTime opens a group (the device sends it first); the others may follow in any
// order. A group is torn, and dropped, when
//   - a message comes twice before the group is complete,
//   - the port reports that frames were lost inside it,
//   - SampleTime and GroupCounter do not advance by the same number of periods,
//   - its frames span more than one sample period by their kernel stamps, and the next SampleTime is not the next one.
// The last rule tells a group that a busy bus delayed from one that took its end from the group after it: the latter
// swallowed a SampleTime. The checks learn the period; kRelearnAfter contradictions in a row make it start afresh (a
// restarted sensor).
#pragma once

#include <array>
#include <cstdint>

#include "core/base/time.hpp"

namespace mapweld::can {

struct XsensGroup {
  enum Part : std::uint8_t { kTime = 1, kCounter = 2, kStatus = 4, kGyro = 8, kAccel = 16 };
  static constexpr std::uint8_t kNeeded = kTime | kCounter | kGyro | kAccel;

  std::uint8_t parts = 0;
  bool done = false;  // gave its sample or was found torn: takes no more
  TimeNs first_receive;
  TimeNs last_receive;
  bool stamped = true;  // all frames so far carry a real receive stamp
  std::uint32_t sample_time_ticks = 0;
  std::uint16_t counter = 0;
  std::uint32_t status = 0;
  std::array<std::int16_t, 3> gyro{};
  std::array<std::int16_t, 3> accel{};
};

class XsensContinuity {
 public:
  static constexpr int kRelearnAfter = 8;

  enum class Verdict : std::uint8_t {
    kGood,
    kTorn,
    kLate,  // good if the next SampleTime FollowsDirectly
  };
  // Whether a complete group can follow the ones before it; remembers it unless it is torn. tick_ns: unit of
  // SampleTime.
  Verdict Judge(const XsensGroup& group, std::int64_t tick_ns);

  // Whether this SampleTime belongs to the group right after the last one remembered.
  [[nodiscard]] bool FollowsDirectly(std::uint32_t sample_time_ticks) const;

 private:
  bool Consistent(const XsensGroup& group);

  bool started_ = false;
  std::uint32_t last_ticks_ = 0;
  std::uint16_t last_counter_ = 0;
  std::int64_t period_ticks_ = 0;  // 0: not known yet
  int contradictions_ = 0;
};

}  // namespace mapweld::can
