// SPDX-License-Identifier: Apache-2.0
// What the sources about this sensor disagree on, concluded from its first groups, before any sample is believed:
//
// The unit of SampleTime. The vendor's pages say 100 us, the 2019 manual and the DBC file 1 us; it depends on the
// firmware. From one group to the next up to kSure100usTicks ticks can only be of 100 us, because no MTi sends 2000
// groups per second; above kMost100usTicks they can only be of 1 us, because odometry needs 5 groups per second.
// Between the two the receive stamps of the whole run tell; without stamps it is 100 us.
//
// Which of the two inertial messages is the acceleration: the manual swaps 0x061 and 0x062 against the driver. A
// vehicle measures 0.6 to 1.4 g at its start and does not turn by 170 deg/s; read as the other quantity, gravity is a
// turn by 281 deg/s and a turn is next to no acceleration. So the two can be told apart, or neither makes sense.
#pragma once

#include <cstdint>

#include "drivers/can/xsens_group.hpp"

namespace mapweld::can {

enum class SampleTimeUnit : std::uint8_t { k100us, k1us, kDetect };
enum class InertialOrder : std::uint8_t { kAsNamed, kSwapped, kDetect };

class XsensStart {
 public:
  static constexpr int kGroups = 8;  // steps from one group to the next that agree, one after the other
  static constexpr std::uint32_t kSure100usTicks = 500;
  static constexpr std::uint32_t kMost100usTicks = 2200;
  static constexpr int kLeastGravityLsb = 1536;  // 6 m/s^2 in units of 2^-8; as a turn in 2^-9 rad/s: 172 deg/s
  static constexpr int kMostGravityLsb = 3584;   // 14 m/s^2

  // kDetect is what will be concluded; the others are taken as they are.
  XsensStart(SampleTimeUnit unit, InertialOrder order) : unit_(unit), order_(order) {}

  // One more complete group; true once nothing is open, at once when nothing ever was.
  bool Push(const XsensGroup& group);

  [[nodiscard]] SampleTimeUnit unit() const { return unit_; }
  [[nodiscard]] bool swapped() const { return order_ == InertialOrder::kSwapped; }

 private:
  // What one group speaks for; kDetect: for nothing.
  [[nodiscard]] InertialOrder OrderOf(const XsensGroup& group) const;
  [[nodiscard]] bool Continues(const XsensGroup& group, std::uint32_t step) const;
  [[nodiscard]] SampleTimeUnit Conclude() const;

  SampleTimeUnit unit_;
  InertialOrder order_;
  int agreeing_ = -1;  // steps of the present run; -1: not one group yet
  XsensGroup first_;   // of the run
  XsensGroup last_;
  std::uint32_t step_ = 0;  // ticks, to last_
  bool stamped_ = false;    // any group of the run
};

}  // namespace mapweld::can
