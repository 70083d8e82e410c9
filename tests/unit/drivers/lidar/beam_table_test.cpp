// SPDX-License-Identifier: Apache-2.0
#include "drivers/lidar/beam_table.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/unit/drivers/lidar/ouster_packet.hpp"

namespace mapweld::lidar {
namespace {

TEST(HesaiAngles, AreReadInAnyOrderOfChannels) {
  BeamTable table;
  ASSERT_EQ(ParseHesaiAngles("Laser id,Elevation,Azimuth\n2,14.0,-0.25\r\n1,15.02,0.1\n\n3,-1,0", 3, &table),
            Status::kOk);
  EXPECT_EQ(table.beams, 3U);
  EXPECT_DOUBLE_EQ(table.elevation_deg[0], 15.02);
  EXPECT_DOUBLE_EQ(table.azimuth_deg[1], -0.25);
  const auto rings = RingsByElevation(table);
  EXPECT_EQ(rings[0], 2);
  EXPECT_EQ(rings[2], 0);
}

TEST(HesaiAngles, AreRefusedUnlessComplete) {
  for (const char* csv : {"", "Laser id,Elevation,Azimuth\n", "h\n1,1,1\n", "h\n1,1,1\n1,2,2\n", "h\n0,1,1\n1,1,1\n",
                          "h\n1,1,1\n3,2,2\n", "h\n1,1,1\n2,nan,2\n", "h\n1,1,1\n2,91,2\n", "h\n1,1,1\n2,1,inf\n",
                          "h\n1,1,1\n1.5,1,1\n", "h\n1,1,1\n2,1\n", "h\n1,1,1\n2;1;1\n", "h\n1,1,1\n2,1,1\n3"}) {
    BeamTable table;
    table.beams = 77;
    EXPECT_EQ(ParseHesaiAngles(csv, 2, &table), Status::kBadInput) << csv;
    EXPECT_EQ(table.beams, 77U) << "untouched";
  }
}

TEST(OusterMetadataText, IsReadWhereverTheKeysStand) {
  OusterMetadata metadata;
  ASSERT_EQ(ParseOusterMetadata(test::OusterJson(128, "RNG15_RFL8_NIR8"), &metadata), Status::kOk);
  EXPECT_EQ(metadata.beams.beams, 128U);
  EXPECT_DOUBLE_EQ(metadata.beams.elevation_deg[0], 22.5);
  EXPECT_DOUBLE_EQ(metadata.beams.azimuth_deg[127], -1.0);
  EXPECT_EQ(metadata.columns_per_turn, 1024);
  EXPECT_DOUBLE_EQ(metadata.origin_to_beam_mm, 15.806);
  EXPECT_EQ(metadata.profile, OusterProfile::kLowRate);
  const char* flat =
      R"({"lidar_mode" : "512x20", "note": "beam_altitude_angles", "beam_azimuth_angles":[1,2], "beam_altitude_angles" :[ 1 ,-2 ]})";
  ASSERT_EQ(ParseOusterMetadata(flat, &metadata), Status::kOk) << "as firmware 1 wrote it";
  EXPECT_EQ(metadata.beams.beams, 2U);
  EXPECT_EQ(metadata.columns_per_turn, 512);
  EXPECT_EQ(metadata.profile, OusterProfile::kLegacy);
  EXPECT_EQ(metadata.origin_to_beam_mm, 0.0);
}

TEST(OusterMetadataText, IsRefusedWhenSomethingIsMissing) {
  const std::string angles = R"("beam_altitude_angles":[1,2],"beam_azimuth_angles":[1,2],)";
  for (const std::string& json :
       {std::string(), "{" + angles + "}", "{" + angles + R"("lidar_mode":"1000x10"})",
        "{" + angles + R"("lidar_mode":1024})", std::string(R"({"beam_altitude_angles":[1,2],"lidar_mode":"1024x10"})"),
        std::string(R"({"beam_altitude_angles":[1,2],"beam_azimuth_angles":[1],"lidar_mode":"1024x10"})"),
        std::string(R"({"beam_altitude_angles":[1,nan],"beam_azimuth_angles":[1,2],"lidar_mode":"1024x10"})"),
        std::string(R"({"beam_altitude_angles":[1,2,"beam_azimuth_angles":[1,2],"lidar_mode":"1024x10"})"),
        "{" + angles + R"("lidar_mode":"1024x10","lidar_origin_to_beam_origin_mm":"a"})", test::OusterJson(129)}) {
    OusterMetadata metadata;
    EXPECT_EQ(ParseOusterMetadata(json, &metadata), Status::kBadInput) << json;
  }
  OusterMetadata metadata;
  EXPECT_EQ(ParseOusterMetadata(test::OusterJson(64, "FUSA_RNG15"), &metadata), Status::kVersion);
}

}  // namespace
}  // namespace mapweld::lidar
