// SPDX-License-Identifier: Apache-2.0
#include "tools/io/pcd.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
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

class PcdEncoding : public ::testing::TestWithParam<Encoding> {};
INSTANTIATE_TEST_SUITE_P(Both, PcdEncoding, ::testing::Values(Encoding::kAscii, Encoding::kBinary));

TEST_P(PcdEncoding, RoundTripsEveryBit) {
  const test::TempFolder folder;
  const PointCloud cloud = Sample();
  WritePcd(folder / "a.pcd", cloud, GetParam());
  const PointCloud back = ReadPcd(folder / "a.pcd");
  EXPECT_EQ(back.points, cloud.points);
  EXPECT_EQ(back.colors, cloud.colors);
  EXPECT_EQ(back.intensities, cloud.intensities);
}

TEST_P(PcdEncoding, RoundTripsCoordinatesAlone) {
  const test::TempFolder folder;
  WritePcd(folder / "a.pcd", {Sample().points, {}, {}}, GetParam());
  const PointCloud back = ReadPcd(folder / "a.pcd");
  EXPECT_EQ(back.points, Sample().points);
  EXPECT_TRUE(back.colors.empty());
  EXPECT_TRUE(back.intensities.empty());
}

TEST_P(PcdEncoding, RoundTripsAnEmptyCloud) {
  const test::TempFolder folder;
  WritePcd(folder / "a.pcd", {}, GetParam());
  EXPECT_TRUE(ReadPcd(folder / "a.pcd").points.empty());
}

TEST_P(PcdEncoding, GivesASentenceForEveryTruncation) {
  const test::TempFolder folder;
  WritePcd(folder / "a.pcd", Sample(), GetParam());
  const std::string bytes = ReadFile(folder / "a.pcd");
  // Cutting digits off the last number of a text file leaves a shorter number: nobody can tell.
  const std::size_t shortest = GetParam() == Encoding::kAscii ? bytes.rfind(' ') + 2 : bytes.size();
  test::ExpectErrorForEveryTruncation(folder, "cut.pcd", bytes, shortest,
                                      [](const auto& path) { (void)ReadPcd(path); });
}

TEST(Pcd, SkipsFieldsItDoesNotKnow) {
  const test::TempFolder folder;
  std::string text =
      "# comment\nVERSION 0.7\nFIELDS ring x y z normal intensity\nSIZE 2 8 4 4 4 1\nTYPE U F F F F U\n"
      "COUNT 1 1 1 1 3 1\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA binary\n";
  text += Raw(std::uint16_t{5}) + Raw(1.5) + Raw(2.5F) + Raw(3.5F) + Raw(0.0F) + Raw(0.0F) + Raw(1.0F) + Raw('\x7F');
  const PointCloud cloud = ReadPcd(folder.Put("a.pcd", text));
  ASSERT_EQ(cloud.points.size(), 1U);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3f(1.5F, 2.5F, 3.5F));
  EXPECT_EQ(cloud.intensities[0], 127.0F);
}

TEST(Pcd, ReadsColourFromTheBitsOfAFloat) {
  const test::TempFolder folder;
  const std::string head =
      "VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ";
  // Opaque: as a float these bits are not a number.
  const PointCloud binary = ReadPcd(
      folder.Put("b.pcd", head + "binary\n" + Raw(1.0F) + Raw(2.0F) + Raw(3.0F) + Raw(std::uint32_t{0xFFFE8001})));
  EXPECT_EQ(binary.colors[0], (Rgb{0xFE, 0x80, 0x01}));
  const float gray = std::bit_cast<float>(std::uint32_t{0x00808182});
  const PointCloud ascii = ReadPcd(folder.Put("a.pcd", head + fmt::format("ascii\n1 2 3 {}\n", gray)));
  EXPECT_EQ(ascii.colors[0], (Rgb{0x80, 0x81, 0x82}));
}

TEST(Pcd, KeepsMissingReturnsForTheCallerToCount) {
  const test::TempFolder folder;
  const PointCloud cloud = ReadPcd(folder.Put("a.pcd",
                                              "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\nDATA ascii\n"
                                              "nan nan nan\n1 2 3\n"));
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_TRUE(std::isnan(cloud.points[0].x()));
}

// 40 points compressed by liblzf 3.6: x = i mod 5, y = 2, z = i div 8, all x first, then all y, then all z.
std::string CompressedByLiblzf() {
  constexpr unsigned char kBlock[] = {
      0x01, 0x00, 0x00, 0x40, 0x00, 0x01, 0x80, 0x3F, 0x20, 0x05, 0x00, 0x40, 0x20, 0x02, 0x20, 0x03, 0x00, 0x80,
      0x20, 0x03, 0x40, 0x00, 0xE0, 0x80, 0x13, 0x40, 0x8F, 0xE0, 0x93, 0x03, 0xE0, 0x16, 0x00, 0x41, 0x47, 0xE0,
      0x13, 0x03, 0xE0, 0x17, 0xDB, 0x41, 0x93, 0xE0, 0x13, 0x03, 0x41, 0xAF, 0xE0, 0x0F, 0x03, 0x01, 0x80, 0x40};
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 40\nHEIGHT 1\nPOINTS 40\n"
         "DATA binary_compressed\n" +
         Raw(std::uint32_t{sizeof(kBlock)}) + Raw(std::uint32_t{480}) +
         std::string(reinterpret_cast<const char*>(kBlock), sizeof(kBlock));
}

TEST(Pcd, ReadsWhatLiblzfCompressed) {
  const test::TempFolder folder;
  const PointCloud cloud = ReadPcd(folder.Put("a.pcd", CompressedByLiblzf()));
  ASSERT_EQ(cloud.points.size(), 40U);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(cloud.points[i], Eigen::Vector3f(static_cast<float>(i % 5), 2, static_cast<float>(i / 8))) << i;
  }
}

TEST(Pcd, GivesASentenceForEveryTruncationOfACompressedFile) {
  const test::TempFolder folder;
  const std::string bytes = CompressedByLiblzf();
  test::ExpectErrorForEveryTruncation(folder, "cut.pcd", bytes, bytes.size(),
                                      [](const auto& path) { (void)ReadPcd(path); });
}

TEST(Pcd, RefusesBadHeadersWithTheirLine) {
  const test::TempFolder folder;
  const std::string tail = "WIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3\n";
  const auto error = [&](const std::string& text) {
    return test::ErrorOf([&] { (void)ReadPcd(folder.Put("a.pcd", text)); });
  };
  EXPECT_THAT(error("FIELDS x y\nSIZE 4 4\nTYPE F F\n" + tail), HasSubstr("no x, y and z fields"));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4\nTYPE F F F\n" + tail), HasSubstr("differ in length"));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\n" + tail), HasSubstr("unknown type F3"));
  EXPECT_THAT(error("\nBOGUS 1\n" + tail), HasSubstr("a.pcd:2: 'BOGUS'"));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 99999999999\nDATA binary\n"), HasSubstr("too large"));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 4000000000\nDATA binary\n"), HasSubstr("truncated"));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA zip\n"), HasSubstr("DATA zip is unknown"));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2\n"),
              HasSubstr("a.pcd:6: found 2"));
}

TEST(Pcd, ReadsTheCloudsOfARealDriver) {
  const char* given = std::getenv("MAPWELD_SHARED_DATA");
  const std::filesystem::path data =
      given != nullptr ? std::filesystem::path(given) : std::filesystem::path(MAPWELD_SOURCE_DIR) / "../shared/data";
  const auto path = data / "packets/vlp16/1673400472138016708.pcd";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data; set MAPWELD_SHARED_DATA";
  const PointCloud cloud = ReadPcd(path);
  ASSERT_EQ(cloud.points.size(), 14831U);
  for (const Eigen::Vector3f& p : cloud.points) ASSERT_LT(p.norm(), 250.0F);
  EXPECT_EQ(cloud.intensities.size(), cloud.points.size());
}

}  // namespace
}  // namespace mapweld::io
