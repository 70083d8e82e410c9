// SPDX-License-Identifier: Apache-2.0
// Status and Result: how core, drivers and firmware-like report that something did not work. No exceptions there.
#pragma once

#include <cstdint>

#include "core/base/assert.hpp"

namespace mapweld {

enum class [[nodiscard]] Status : std::uint8_t{
    kOk = 0,
    kFull,        // a fixed capacity is reached; the type says what happens to the newcomer
    kEmpty,       // nothing there
    kOutOfRange,  // an index or a value outside its documented range
    kBadInput,    // bytes or samples from outside that do not make sense
    kStale,       // older than what is already known
    kNotReady,    // needs more data first
    kDegenerate,  // geometry that does not determine the answer
    kTimeout,
    kIo,       // the operating system said no; errno tells why
    kCrc,      // checksum mismatch
    kVersion,  // another type or format version
};

// A fixed English word for logs and counters; never null.
const char* StatusName(Status status);

// A value or the reason why there is none. T must be cheap to copy and default constructible.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(const T& value) : value_(value) {}                                           // NOLINT: implicit on purpose
  Result(Status status) : status_(status) { MAPWELD_ASSERT(status != Status::kOk); }  // NOLINT

  [[nodiscard]] bool ok() const { return status_ == Status::kOk; }
  [[nodiscard]] Status status() const { return status_; }
  const T& value() const {
    MAPWELD_ASSERT(ok());
    return value_;
  }

 private:
  T value_{};
  Status status_ = Status::kOk;
};

}  // namespace mapweld
