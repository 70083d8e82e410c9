// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/dbc_imu_codec.hpp"

#include <linux/can.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mapweld::can {
namespace {

constexpr std::size_t kGyroSignals = 3;

// Size of the unit in SI; 0 when it is not one of the quantity.
double SiOf(std::string_view unit, bool gyro) {
  constexpr double kStandardGravity = 9.80665;
  if (gyro) {
    if (unit == "rad/s") return 1.0;
    return unit == "deg/s" ? std::numbers::pi / 180.0 : 0.0;
  }
  if (unit == "m/s^2" || unit == "m/s2") return 1.0;
  if (unit == "g") return kStandardGravity;
  return unit == "mg" ? kStandardGravity * 1e-3 : 0.0;
}

}  // namespace

Status DbcImuCodec::Configure(std::string_view dbc, std::string_view names) {
  wanted_ids_.clear();
  for (std::size_t i = 0; i < kSignals; ++i) {
    const std::size_t end = std::min(names.find(','), names.size());
    if ((end == names.size()) != (i + 1 == kSignals)) return Status::kBadInput;
    DbcSignal& signal = signals_[i];
    if (const Status status = FindDbcSignal(dbc, names.substr(0, end), &signal); status != Status::kOk) return status;
    names.remove_prefix(std::min(end + 1, names.size()));
    const double si = SiOf(signal.unit, i < kGyroSignals);
    if (si == 0.0) return Status::kBadInput;
    signal.factor *= si;
    signal.offset *= si;
    signal.unit = {};
    const std::uint32_t id = signal.id | (signal.extended ? CAN_EFF_FLAG : 0U);
    if (std::find(wanted_ids_.begin(), wanted_ids_.end(), id) == wanted_ids_.end()) (void)wanted_ids_.TryPush(id);
  }
  return Status::kOk;
}

void DbcImuCodec::Tear() {
  if (present_ != 0) ++counters_.torn;
  present_ = 0;
}

Status DbcImuCodec::Push(const CanFrame& frame, sensor::ImuSample* sample) {
  ++counters_.frames;
  const auto refuse = [](std::uint64_t* cause) {
    ++*cause;
    return Status::kBadInput;
  };
  if (frame.gap) Tear();
  if (frame.error) return refuse(&counters_.error_frames);
  std::uint8_t parts = 0;
  for (std::size_t i = 0; i < kSignals; ++i) {
    if (frame.remote || !IsFrom(signals_[i], frame)) continue;
    if (frame.dlc != signals_[i].dlc) return refuse(&counters_.wrong_dlc);
    parts = static_cast<std::uint8_t>(parts | 1U << i);
  }
  if (parts == 0) return refuse(&counters_.unknown_id);
  if ((parts & 1U) != 0 || (parts & present_) != 0) Tear();
  if ((parts & 1U) != 0) {
    begun_ = frame.receive;
  } else if (present_ == 0) {
    return Status::kNotReady;  // its sample was never opened, or is torn and counted
  }
  for (std::size_t i = 0; i < kSignals; ++i) {
    if ((parts >> i & 1U) == 0) continue;
    values_[i] = DbcValue(signals_[i], frame);
    if (!(std::abs(values_[i]) <= (i < kGyroSignals ? kMaxGyroRadS : kMaxAccelMs2))) {
      present_ = 0;
      return refuse(&counters_.out_of_range);
    }
  }
  present_ = static_cast<std::uint8_t>(present_ | parts);
  if (present_ != kAll) return Status::kNotReady;
  present_ = 0;
  if (counters_.samples > 0 && begun_ <= last_t_) {
    ++counters_.stale;
    return Status::kStale;
  }
  last_t_ = begun_;
  ++counters_.samples;
  sample->t = begun_;
  sample->gyro_body = {values_[0], values_[1], values_[2]};
  sample->accel_body = {values_[3], values_[4], values_[5]};
  sample->clipped = false;
  return Status::kOk;
}

}  // namespace mapweld::can
