// SPDX-License-Identifier: Apache-2.0
// Small images as data URIs, so that the report is one file.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mapweld::report {

// One byte per pixel, row-major from the top left: an index into `palette`.
struct PaletteImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
  std::vector<std::array<std::uint8_t, 4>> palette;  // red, green, blue, alpha; at most 256
};

// Throws when the image has no pixels or libpng fails.
std::string EncodePng(const PaletteImage& image);
std::string Base64(std::string_view bytes);
// "data:image/png;base64,..."
std::string PngDataUri(const PaletteImage& image);
// Black to white.
std::vector<std::array<std::uint8_t, 4>> GrayPalette();

}  // namespace mapweld::report
