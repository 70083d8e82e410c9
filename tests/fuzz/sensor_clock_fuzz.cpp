// SPDX-License-Identifier: Apache-2.0
// First byte: mode and sensor. Then readings: 8 bytes ticks, 8 bytes receive time, both anything.
#include <algorithm>
#include <limits>

#include "drivers/time/sensor_clock.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace mapweld::fuzz {

std::vector<Bytes> Seeds() {
  std::vector<Bytes> out;
  for (std::uint8_t mode = 0; mode < 4; ++mode) {
    Bytes bytes{mode};
    for (std::uint64_t i = 0; i < 12; ++i) {
      const std::uint64_t ticks = (i < 3 ? 3'599'999'000 : 0) + i * 1327;
      const std::uint64_t receive = 1'000'000'000 + i * 1'327'000;
      for (const std::uint64_t value : {ticks, receive}) {
        for (unsigned shift = 64; shift > 0; shift -= 8)
          bytes.push_back(static_cast<std::uint8_t>(value >> (shift - 8)));
      }
    }
    out.push_back(bytes);
  }
  return out;
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld;
  fuzz::Input input(data, size);
  const std::uint64_t selector = input.Number(1);
  time::SensorClockOptions options = (selector & 1U) != 0 ? time::kXsens100usClock : time::kLidarHourClock;
  options.mode = (selector & 2U) != 0 ? time::ClockMode::kReceive : time::ClockMode::kShared;
  time::SensorClock clock(options);
  if ((selector & 4U) != 0) clock.Anchor({static_cast<std::int64_t>(input.Number(6))});
  // Receive times come from a monotonic clock or a log whose reader limits them: not negative, within 285 years.
  constexpr std::int64_t kLatest = 9'000'000'000'000'000'000;
  std::uint64_t refused = 0;
  std::uint64_t readings = 0;
  for (; !input.empty(); ++readings) {
    const std::uint64_t ticks = input.Number(8);
    const auto receive = static_cast<std::int64_t>(input.Number(8) % static_cast<std::uint64_t>(kLatest));
    TimeNs t{-1};
    if (clock.ToTime(ticks, {receive}, &t) != Status::kOk) {
      FUZZ_REQUIRE(t.ns == -1);
      ++refused;
    }
  }
  FUZZ_REQUIRE(clock.counters().accepted + refused == readings);
  return 0;
}
