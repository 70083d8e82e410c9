// SPDX-License-Identifier: Apache-2.0
#include "tools/io/ply.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/unit/tools/io/temp_folder.hpp"
#include "tools/io/text_rows.hpp"

namespace mapweld::io {
namespace {

using ::testing::HasSubstr;

PointCloud Sample() {
  return {{{1.25F, -2.5F, 3}, {0.1F, 1e-9F, -1234.5678F}, {7, 8, 9}},
          {{{255, 0, 1}}, {{0, 128, 64}}, {{12, 34, 56}}},
          {0.5F, 200, 0}};
}

template <class T>
std::string Raw(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

class PlyEncoding : public ::testing::TestWithParam<Encoding> {};
INSTANTIATE_TEST_SUITE_P(Both, PlyEncoding, ::testing::Values(Encoding::kAscii, Encoding::kBinary));

TEST_P(PlyEncoding, RoundTripsEveryBit) {
  const test::TempFolder folder;
  const PointCloud cloud = Sample();
  WritePly(folder / "a.ply", cloud, GetParam());
  const PointCloud back = ReadPly(folder / "a.ply");
  EXPECT_EQ(back.points, cloud.points);
  EXPECT_EQ(back.colors, cloud.colors);
  EXPECT_EQ(back.intensities, cloud.intensities);
}

TEST_P(PlyEncoding, RoundTripsAnEmptyCloud) {
  const test::TempFolder folder;
  WritePly(folder / "a.ply", {}, GetParam());
  EXPECT_TRUE(ReadPly(folder / "a.ply").points.empty());
}

TEST_P(PlyEncoding, GivesASentenceForEveryTruncation) {
  const test::TempFolder folder;
  WritePly(folder / "a.ply", Sample(), GetParam());
  const std::string bytes = ReadFile(folder / "a.ply");
  const std::size_t shortest = GetParam() == Encoding::kAscii ? bytes.rfind(' ') + 2 : bytes.size();
  test::ExpectErrorForEveryTruncation(folder, "cut.ply", bytes, shortest,
                                      [](const auto& path) { (void)ReadPly(path); });
}

TEST(Ply, WritesTheSameBytesTwice) {
  const test::TempFolder folder;
  WritePly(folder / "a.ply", Sample());
  WritePly(folder / "b.ply", Sample());
  EXPECT_EQ(ReadFile(folder / "a.ply"), ReadFile(folder / "b.ply"));
}

TEST(Ply, SkipsElementsInFrontOfTheVerticesAndUnknownProperties) {
  const test::TempFolder folder;
  std::string text =
      "ply\nformat binary_little_endian 1.0\ncomment c\nobj_info o\nelement camera 2\nproperty double a\n"
      "property uchar b\nelement vertex 1\nproperty short ring\nproperty double x\nproperty float y\nproperty float z\n"
      "element face 7\nproperty list uchar int vertex_indices\nend_header\n";
  text += std::string(18, '?') + Raw(std::int16_t{3}) + Raw(1.5) + Raw(2.5F) + Raw(3.5F);
  const PointCloud cloud = ReadPly(folder.Put("a.ply", text));
  ASSERT_EQ(cloud.points.size(), 1U);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3f(1.5F, 2.5F, 3.5F));

  const PointCloud ascii = ReadPly(folder.Put("b.ply",
                                              "ply\r\nformat ascii 1.0\r\nelement camera 1\r\nproperty int a\r\n"
                                              "element vertex 1\r\nproperty float x\r\nproperty float y\r\n"
                                              "property float z\r\nend_header\r\n77\r\n1 2 3\r\n"));
  ASSERT_EQ(ascii.points.size(), 1U);
  EXPECT_EQ(ascii.points[0], Eigen::Vector3f(1, 2, 3));
}

TEST(Ply, RefusesBadHeadersWithTheirLine) {
  const test::TempFolder folder;
  const auto error = [&](const std::string& text) {
    return test::ErrorOf([&] { (void)ReadPly(folder.Put("a.ply", text)); });
  };
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  EXPECT_THAT(error("solid\n"), HasSubstr("a.ply:1: this is no PLY file"));
  EXPECT_THAT(error("ply\nformat binary_big_endian 1.0\n"), HasSubstr("a.ply:2: format binary_big_endian"));
  EXPECT_THAT(error("ply\nformat ascii 1.0\nelement vertex -3\n"), HasSubstr("'-3' is not a count"));
  EXPECT_THAT(error("ply\nformat ascii 1.0\nend_header\n"), HasSubstr("no vertex element"));
  EXPECT_THAT(error("ply\nelement vertex 1\n" + xyz + "end_header\n1 2 3\n"), HasSubstr("names no format"));
  EXPECT_THAT(error("ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int i\nelement vertex 1\n"),
              HasSubstr("only plain numbers"));
  EXPECT_THAT(error("ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\n" + xyz + "end_header\n"),
              HasSubstr("truncated"));
}

TEST(Ply, ReadsTheCloudsOfCloudCompare) {
  const char* given = std::getenv("MAPWELD_SHARED_DATA");
  const std::filesystem::path data =
      given != nullptr ? std::filesystem::path(given) : std::filesystem::path(MAPWELD_SOURCE_DIR) / "../shared/data";
  const auto path = data / "registration/source.ply";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data; set MAPWELD_SHARED_DATA";
  const PointCloud cloud = ReadPly(path);
  EXPECT_EQ(cloud.points.size(), 69792U);
  EXPECT_EQ(cloud.intensities.size(), 69792U);
  for (const Eigen::Vector3f& p : cloud.points) ASSERT_LT(p.norm(), 250.0F);
}

}  // namespace
}  // namespace mapweld::io
