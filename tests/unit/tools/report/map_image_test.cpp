// SPDX-License-Identifier: Apache-2.0
#include "tools/report/map_image.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include "tests/unit/tools/io/temp_folder.hpp"

namespace mapweld::report {
namespace {

using Pixel = std::array<std::uint8_t, 4>;

// A flat 100 x 60 m field with a tall wall along y = 10 from x = 20 to x = 40.
std::vector<MapPoint> FieldWithWall() {
  std::vector<MapPoint> points;
  for (int x = 0; x < 200; ++x) {
    for (int y = 0; y < 120; ++y) {
      points.push_back({{0.5F * static_cast<float>(x), 0.5F * static_cast<float>(y) - 30, 0}, 0});
    }
  }
  for (int x = 40; x < 80; ++x) {
    for (int z = 0; z < 20; ++z)
      points.push_back({{0.5F * static_cast<float>(x), 10, 0.5F * static_cast<float>(z)}, 0});
  }
  return points;
}

Pixel PixelAt(const PaletteImage& image, const MapView& view, double x, double y) {
  const Eigen::Vector2d p = view.ToDrawing({x, y, 0});
  const auto column = static_cast<std::size_t>(p.x() / view.width * image.width);
  const auto row = static_cast<std::size_t>(p.y() / view.height * image.height);
  return image.palette.at(image.pixels.at(row * static_cast<std::size_t>(image.width) + column));
}

TEST(MapImage, ShowsWallsStrongerAndBrighterThanGroundAndNothingWhereNothingIs) {
  const auto points = FieldWithWall();
  const MapView view = FitView(points, {}, 1000, 800);
  const PaletteImage image = RenderMap(points, view);
  const Pixel wall = PixelAt(image, view, 30.1, 9.9);
  const Pixel ground = PixelAt(image, view, 70.1, -19.9);
  EXPECT_GT(wall[3], ground[3]);
  EXPECT_GT(wall[0] + wall[1] + wall[2], ground[0] + ground[1] + ground[2] + 100);
  EXPECT_GT(ground[3], 0);
  EXPECT_EQ(PixelAt(image, view, -4, -34)[3], 0);
}

TEST(MapImage, ShowsAHillAsGround) {
  std::vector<MapPoint> points = FieldWithWall();
  for (MapPoint& p : points) p.p_merged.z() += 0.05F * p.p_merged.x() + 100;
  const MapView view = FitView(points, {}, 1000, 800);
  const PaletteImage image = RenderMap(points, view);
  const Pixel low = PixelAt(image, view, 10.1, -19.9);
  const Pixel high = PixelAt(image, view, 90.1, -19.9);
  EXPECT_NEAR(low[0], high[0], 40);
}

TEST(MapView, HasXToTheRightAndYUp) {
  const MapView view = FitView(FieldWithWall(), {}, 1000, 800);
  EXPECT_LT(view.ToDrawing({0, 0, 0}).x(), view.ToDrawing({50, 0, 0}).x());
  EXPECT_GT(view.ToDrawing({0, -20, 0}).y(), view.ToDrawing({0, 20, 0}).y());
  EXPECT_LE(view.width, 1000 + 1e-9);
  EXPECT_LE(view.height, 800 + 1e-9);
}

TEST(MapView, IsNotShrunkByOneStrayPoint) {
  auto points = FieldWithWall();
  const MapView before = FitView(points, {{{}}}, 1000, 800);
  points.push_back({{90000, 90000, 0}, 0});
  EXPECT_LT(FitView(points, {{{}}}, 1000, 800).m_per_unit, 1.5 * before.m_per_unit);
}

TEST(MapView, ContainsEveryTrajectory) {
  const geom::Pose3 far = {{500, -700, 0}, geom::Quatd::Identity()};
  const MapView view = FitView(FieldWithWall(), {{far}}, 1000, 800);
  const Eigen::Vector2d p = view.ToDrawing(far.t);
  EXPECT_GT(p.x(), 0);
  EXPECT_LT(p.x(), view.width);
  EXPECT_LT(p.y(), view.height);
}

TEST(MapView, OfNothingIsStillAPicture) {
  const MapView view = FitView({}, {}, 1000, 800);
  const PaletteImage image = RenderMap({}, view);
  EXPECT_GT(image.width, 0);
  EXPECT_GT(image.height, 0);
  EXPECT_FALSE(EncodePng(image).empty());
}

TEST(PngImage, ReadsBackAsItWasDrawn) {
  PaletteImage image;
  image.width = 5;
  image.height = 3;
  image.palette = {{0, 0, 0, 0}, {10, 20, 30, 255}, {200, 100, 50, 128}};
  for (int i = 0; i < 15; ++i) image.pixels.push_back(static_cast<std::uint8_t>(i % 3));
  const std::string png = EncodePng(image);
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&header, png.data(), png.size()), 0);
  header.format = PNG_FORMAT_RGBA;
  std::vector<Pixel> pixels(15);
  ASSERT_EQ(header.width, 5U);
  ASSERT_EQ(header.height, 3U);
  ASSERT_NE(png_image_finish_read(&header, nullptr, pixels.data(), 0, nullptr), 0);
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_EQ(pixels[i][3], image.palette[i % 3][3]) << i;
    EXPECT_TRUE(pixels[i][3] == 0 || pixels[i] == image.palette[i % 3]) << i;
  }
}

TEST(PngImage, RefusesPicturesOfTheWrongSize) {
  EXPECT_NE(test::ErrorOf([] { (void)EncodePng({4, 4, {1, 2}, GrayPalette()}); }), "");
  EXPECT_NE(test::ErrorOf([] { (void)EncodePng({0, 0, {}, GrayPalette()}); }), "");
}

// The examples of RFC 4648.
TEST(Base64, PadsAsTheStandardSays) {
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foo"), "Zm9v");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(Base64("\xFF\xFE\xFD"), "//79");
}

}  // namespace
}  // namespace mapweld::report
