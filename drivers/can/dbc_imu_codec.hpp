// SPDX-License-Identifier: Apache-2.0
// Builds IMU samples from the frames of any IMU that a .dbc file describes. Six signals are needed, by name: turn rates
// x, y, z and accelerations x, y, z in the body frame (x forward, y left, z up). Their units are taken from the file:
// rad/s, deg/s; m/s^2, m/s2, g, mg. They may come in one message or several; the message of the first signal opens a
// sample, which is complete when all others came after it. A sample's time is the receive time of its first frame:
// such an IMU has no clock of its own, so the agent's clocks must run free (`--time receive`).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/base/fixed_vector.hpp"
#include "core/base/status.hpp"
#include "core/sensor/imu_sample.hpp"
#include "drivers/can/can_frame.hpp"
#include "drivers/can/dbc_file.hpp"

namespace mapweld::can {

class DbcImuCodec {
 public:
  static constexpr std::size_t kSignals = 6;
  // No IMU of a vehicle measures more: what lies outside is a fault.
  static constexpr double kMaxGyroRadS = 70.0;
  static constexpr double kMaxAccelMs2 = 400.0;

  struct Counters {
    std::uint64_t frames = 0;
    std::uint64_t samples = 0;
    // refused frames
    std::uint64_t error_frames = 0;
    std::uint64_t unknown_id = 0;  // remote frames too
    std::uint64_t wrong_dlc = 0;
    std::uint64_t out_of_range = 0;
    // refused samples
    std::uint64_t torn = 0;   // a message missing, or frames lost inside it
    std::uint64_t stale = 0;  // time did not go forward
    [[nodiscard]] std::uint64_t Rejected() const {
      return error_frames + unknown_id + wrong_dlc + out_of_range + torn + stale;
    }
  };

  // names: gyro x, y, z, accel x, y, z, separated by commas. kBadInput: not six names, or a unit that is none of the
  // above; otherwise as FindDbcSignal. The codec keeps nothing of the text.
  Status Configure(std::string_view dbc, std::string_view names);

  // The identifiers of the messages it needs, for the kernel's filter; 29-bit ones with CAN_EFF_FLAG.
  [[nodiscard]] std::span<const std::uint32_t> wanted_ids() const { return wanted_ids_; }

  // kOk: *sample is a new sample; kNotReady: the frame was used; everything else is a refusal, counted by cause.
  Status Push(const CanFrame& frame, sensor::ImuSample* sample);

  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  static constexpr std::uint8_t kAll = (1U << kSignals) - 1;

  [[nodiscard]] bool IsFrom(const DbcSignal& signal, const CanFrame& frame) const {
    return signal.id == frame.id && signal.extended == frame.extended;
  }
  void Tear();

  std::array<DbcSignal, kSignals> signals_{};
  FixedVector<std::uint32_t, kSignals> wanted_ids_;
  std::array<double, kSignals> values_{};
  std::uint8_t present_ = 0;  // a bit per signal
  TimeNs begun_;
  TimeNs last_t_;
  Counters counters_;
};

}  // namespace mapweld::can
