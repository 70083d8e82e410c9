// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/xsens_encoder.hpp"

#include <cmath>

#include "core/base/byte_io.hpp"

namespace mapweld::sim {
namespace {

template <typename T>
CanFrame IntegerFrame(std::uint32_t id, T value) {
  CanFrame frame{id, sizeof(T), {}};
  ByteWriter writer(frame.data);
  writer.Big(value);
  return frame;
}

// `clip_bit` of the x axis; the others follow it.
CanFrame VectorFrame(std::uint32_t id, const geom::Vec3d& value, double steps_per_unit, unsigned clip_bit,
                     std::uint32_t& status) {
  constexpr std::uint32_t kAnyClipping = 1U << 19U;
  CanFrame frame{id, 6, {}};
  ByteWriter writer(frame.data);
  for (unsigned axis = 0; axis < 3; ++axis) {
    double steps = std::round(value[axis] * steps_per_unit);
    if (steps > 32767 || steps < -32768) {
      steps = steps > 0 ? 32767 : -32768;
      status |= (1U << (clip_bit + axis)) | kAnyClipping;
    }
    writer.Big(static_cast<std::int16_t>(steps));
  }
  return frame;
}

}  // namespace

std::array<CanFrame, Xsens::kFrames> EncodeXsens(const XsensSample& sample) {
  constexpr unsigned kClipAccel = 8;
  constexpr unsigned kClipGyro = 11;
  std::uint32_t status = Xsens::kHealthy;
  const CanFrame rate = VectorFrame(Xsens::kRateOfTurn, sample.gyro_body, 512, kClipGyro, status);
  const CanFrame accel = VectorFrame(Xsens::kAcceleration, sample.accel_body, 256, kClipAccel, status);
  return {IntegerFrame(Xsens::kSampleTime, sample.time_100us), IntegerFrame(Xsens::kGroupCounter, sample.counter),
          IntegerFrame(Xsens::kStatusWord, status), rate, accel};
}

}  // namespace mapweld::sim
