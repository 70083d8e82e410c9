// SPDX-License-Identifier: Apache-2.0
// Maps the wrapping tick counter of one sensor to TimeNs.
//   kShared   all sensors run on one synchronised clock (PTP, PPS, a simulator): ticks are only unwrapped, so that two
//             sensors with the same reading get the same time.
//   kReceive  the sensor's clock runs free: its offset to the receive clock is the lower envelope of (receive -
//   sensor),
//             because transport delays only ever add. The envelope moves by at most kSlewPpm, so time never jumps.
// A reading that jumps backwards by more than a second (in kReceive also one that runs ahead of the receive clock by
// that much) is refused; kResyncSamples refused readings that agree with each other are believed: the sensor was
// restarted. Cost: constant, no loops over data. Owns nothing.
#pragma once

#include <cstdint>

#include "core/base/status.hpp"
#include "core/base/time.hpp"

namespace mapweld::time {

enum class ClockMode : std::uint8_t { kShared, kReceive };

struct SensorClockOptions {
  ClockMode mode = ClockMode::kShared;
  std::int64_t tick_ns = 1000;
  std::uint64_t wrap_ticks = 3'600'000'000;  // the counter runs 0 .. wrap_ticks - 1
};

inline constexpr SensorClockOptions kLidarHourClock{ClockMode::kShared, 1000, 3'600'000'000};
inline constexpr SensorClockOptions kXsens100usClock{ClockMode::kShared, 100'000, 1ULL << 32U};
inline constexpr SensorClockOptions kXsens1usClock{ClockMode::kShared, 1000, 1ULL << 32U};

class SensorClock {
 public:
  static constexpr DurationNs kJump = Milliseconds(1000);
  static constexpr DurationNs kLongestSilence = Milliseconds(86'400'000);  // after more than a day it is a restart
  static constexpr int kResyncSamples = 8;
  static constexpr std::int64_t kSlewPpm = 200;              // crystals differ by less
  static constexpr DurationNs kSettle = Milliseconds(1000);  // until then the envelope may fall at once

  struct Counters {
    std::uint64_t accepted = 0;
    std::uint64_t out_of_range = 0;  // ticks >= wrap_ticks
    std::uint64_t jumps = 0;         // refused readings
    std::uint64_t resyncs = 0;
  };

  explicit SensorClock(const SensorClockOptions& options) : options_(options) {}

  // ticks: the sensor's reading; receive: when it came in, any clock that does not jump.
  // kOutOfRange for ticks >= wrap_ticks, kStale for a refused jump; *out is then unchanged.
  Status ToTime(std::uint64_t ticks, TimeNs receive, TimeNs* out);

  // kShared only: a time near the present, for example the newest sample of the other sensor. The first reading and a
  // reading after a restart are then unwrapped to the turn of the counter nearest to it.
  void Anchor(TimeNs near) {
    anchor_ = near;
    anchored_ = true;
  }

  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  [[nodiscard]] DurationNs Step(std::uint64_t from_ticks, std::uint64_t to_ticks) const;
  [[nodiscard]] TimeNs Nearest(std::uint64_t ticks, TimeNs to) const;
  void Start(std::uint64_t ticks, TimeNs receive);
  bool AgreesWithCandidate(std::uint64_t ticks, TimeNs receive);
  void MoveEnvelope(DurationNs since_last, TimeNs receive);

  SensorClockOptions options_;
  Counters counters_;
  bool started_ = false;
  bool anchored_ = false;
  TimeNs anchor_;
  std::uint64_t last_ticks_ = 0;
  TimeNs last_receive_;
  TimeNs sensor_;       // unwrapped, of last_ticks_
  DurationNs offset_;   // kReceive: receive clock minus sensor clock
  DurationNs settled_;  // sensor time since the start or the last resync
  std::uint64_t candidate_ticks_ = 0;
  TimeNs candidate_receive_;
  int candidates_ = 0;
};

}  // namespace mapweld::time
