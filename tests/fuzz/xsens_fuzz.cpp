// SPDX-License-Identifier: Apache-2.0
// First byte: options. Then frames of 16 bytes: 2 identifier, 1 flags, 1 length, 4 time since the last frame in us, 8
// data.
#include <cmath>

#include "drivers/can/xsens_codec.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/unit/drivers/can/xsens_frames.hpp"

namespace mapweld::fuzz {

std::vector<Bytes> Seeds() {
  std::vector<Bytes> out;
  for (std::uint8_t options = 0; options < 16; ++options) {
    Bytes bytes{options};
    const std::uint32_t groups = options < 4 ? 4 : 12;  // enough to detect what there is to detect
    for (std::uint32_t k = 0; k < groups; ++k) {
      for (const can::CanFrame& frame : can::test::Group({.ticks = 25 * k, .counter = static_cast<std::uint16_t>(k)})) {
        bytes.push_back(static_cast<std::uint8_t>(frame.id >> 8U));
        bytes.push_back(static_cast<std::uint8_t>(frame.id));
        bytes.push_back(0);
        bytes.push_back(frame.dlc);
        bytes.insert(bytes.end(), {0, 0, 1, 0});
        bytes.insert(bytes.end(), frame.data.begin(), frame.data.end());
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
  const can::SampleTimeUnit told = (selector & 1U) != 0 ? can::SampleTimeUnit::k1us : can::SampleTimeUnit::k100us;
  can::XsensCodec codec(
      {.sample_time_unit = (selector & 4U) != 0 ? can::SampleTimeUnit::kDetect : told,
       .inertial_order = (selector & 8U) != 0 ? can::InertialOrder::kDetect : can::InertialOrder::kAsNamed,
       .clock_mode = (selector & 2U) != 0 ? time::ClockMode::kReceive : time::ClockMode::kShared});
  TimeNs receive{1};
  TimeNs last{-1};
  std::uint64_t samples = 0;
  while (!input.empty()) {
    can::CanFrame frame;
    frame.id = static_cast<std::uint32_t>(input.Number(2)) & 0x7FFU;
    const std::uint64_t flags = input.Number(1);
    frame.extended = (flags & 1U) != 0;
    frame.remote = (flags & 2U) != 0;
    frame.error = (flags & 4U) != 0;
    frame.gap = (flags & 8U) != 0;
    frame.stamped = (flags & 16U) == 0;
    frame.dlc = static_cast<std::uint8_t>(input.Number(1) % 9);
    receive.ns += static_cast<std::int64_t>(input.Number(4)) * 1000;
    frame.receive = receive;
    for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(input.Number(1));
    sensor::ImuSample sample;
    if (codec.Push(frame, &sample) != Status::kOk) continue;
    ++samples;
    FUZZ_REQUIRE(sample.t > last);
    last = sample.t;
    FUZZ_REQUIRE(sample.gyro_body.cwiseAbs().maxCoeff() <= can::XsensCodec::kMaxGyroRadS);
    FUZZ_REQUIRE(sample.accel_body.cwiseAbs().maxCoeff() <= can::XsensCodec::kMaxAccelMs2);
  }
  FUZZ_REQUIRE(codec.counters().samples == samples);
  return 0;
}
