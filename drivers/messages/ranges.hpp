// SPDX-License-Identifier: Apache-2.0
// The checks that the messages share.
#pragma once

#include <cmath>
#include <cstdint>

#include "drivers/messages/validate.hpp"

namespace mapweld::messages {

template <class T>
bool Within(T value, T low, T high) {
  return value >= low && value <= high;  // false for NaN
}

inline bool IsSender(std::int16_t agent_id, std::int32_t epoch) {
  return agent_id >= 1 && epoch >= 1;
}

template <class T>
bool IsSize(T value) {
  return std::isfinite(value) && value >= T{0};
}

inline bool IsPosition(const double (&t)[3]) {
  for (const double x : t) {
    if (!Within(x, -kMaxPositionM, kMaxPositionM)) return false;
  }
  return true;
}

inline bool IsUnitQuaternion(const double (&q)[4]) {
  double sum = 0;
  for (const double x : q) {
    if (!Within(x, -2.0, 2.0)) return false;
    sum += x * x;
  }
  return std::abs(std::sqrt(sum) - 1.0) <= kUnitNormTolerance;
}

inline Status OkIf(bool good) {
  return good ? Status::kOk : Status::kOutOfRange;
}

}  // namespace mapweld::messages
