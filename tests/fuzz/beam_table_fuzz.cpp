// SPDX-License-Identifier: Apache-2.0
// The input is a calibration file, read as Ouster metadata and as Hesai angles.
#include <cmath>
#include <string_view>

#include "drivers/lidar/beam_table.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace mapweld::fuzz {
namespace {

void RequireGood(const lidar::BeamTable& table) {
  FUZZ_REQUIRE(table.beams <= lidar::BeamTable::kMaxBeams);
  for (std::size_t i = 0; i < table.beams; ++i) {
    FUZZ_REQUIRE(std::abs(table.elevation_deg[i]) <= 360.0 && std::abs(table.azimuth_deg[i]) <= 360.0);
  }
}

}  // namespace

std::vector<Bytes> Seeds() {
  return TextSeeds(
      {std::string_view("Laser id,Elevation,Azimuth\n1,15.02,0.1\n2,14.0,-0.25\n3,13e0,0\n4,-1,0\n"),
       std::string_view(R"({"lidar_mode":"1024x10","beam_altitude_angles":[16.6,-1.5e1],"beam_azimuth_angles":[3,-3],)"
                        R"("lidar_origin_to_beam_origin_mm":15.8,"udp_profile_lidar":"RNG15_RFL8_NIR8"})")});
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld;
  const fuzz::Bytes copy(data, data + size);  // of its own size, so that the address sanitizer sees its end
  const std::string_view text(reinterpret_cast<const char*>(copy.data()), copy.size());
  lidar::OusterMetadata metadata;
  if (lidar::ParseOusterMetadata(text, &metadata) == Status::kOk) {
    fuzz::RequireGood(metadata.beams);
    FUZZ_REQUIRE(metadata.beams.beams > 0 && metadata.columns_per_turn >= 512);
  }
  lidar::BeamTable table;
  if (lidar::ParseHesaiAngles(text, 4, &table) == Status::kOk) {
    FUZZ_REQUIRE(table.beams == 4);
    fuzz::RequireGood(table);
  }
  return 0;
}
