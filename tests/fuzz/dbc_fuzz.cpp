// SPDX-License-Identifier: Apache-2.0
// First byte: how many frames of 13 bytes (4 identifier and flags, 1 length, 8 data) follow; the rest is a CAN database
// that describes the IMU which sends them.
#include <cmath>
#include <string_view>

#include "drivers/can/dbc_imu_codec.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/unit/drivers/can/dbc_text.hpp"

namespace mapweld::fuzz {

std::vector<Bytes> Seeds() {
  const std::string_view text = can::test::kDbc.substr(can::test::kDbc.find("BO_ 50"), 500);
  Bytes bytes{2, 0, 0, 0, 50, 6, 1, 2, 3, 4, 5, 6, 0, 0, 0, 0, 0, 52, 6, 1, 2, 3, 4, 5, 6, 0, 0};
  bytes.insert(bytes.end(), text.begin(), text.end());
  return {bytes};
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld;
  fuzz::Input input(data, size);
  std::vector<can::CanFrame> frames(input.Number(1) % 16);
  std::int64_t t_ns = 0;
  for (can::CanFrame& frame : frames) {
    const std::uint64_t id = input.Number(4);
    frame.extended = (id >> 31U & 1U) != 0;
    frame.gap = (id >> 30U & 1U) != 0;
    frame.id = static_cast<std::uint32_t>(id) & (frame.extended ? 0x1FFFFFFFU : 0x7FFU);
    frame.dlc = static_cast<std::uint8_t>(input.Number(1) % 9);
    frame.receive = {++t_ns};
    for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(input.Number(1));
  }
  const fuzz::Bytes rest = input.Rest();
  can::DbcImuCodec codec;
  if (codec.Configure({reinterpret_cast<const char*>(rest.data()), rest.size()}, can::test::kMotorolaNames) !=
      Status::kOk) {
    return 0;
  }
  FUZZ_REQUIRE(!codec.wanted_ids().empty());
  for (const can::CanFrame& frame : frames) {
    sensor::ImuSample sample;
    if (codec.Push(frame, &sample) != Status::kOk) continue;
    FUZZ_REQUIRE(sample.gyro_body.cwiseAbs().maxCoeff() <= can::DbcImuCodec::kMaxGyroRadS);
    FUZZ_REQUIRE(sample.accel_body.cwiseAbs().maxCoeff() <= can::DbcImuCodec::kMaxAccelMs2);
  }
  FUZZ_REQUIRE(codec.counters().frames == frames.size());
  return 0;
}
