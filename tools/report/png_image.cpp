// SPDX-License-Identifier: Apache-2.0
#include "tools/report/png_image.hpp"

#include <fmt/format.h>
#include <png.h>

#include <cstddef>
#include <stdexcept>

namespace mapweld::report {

std::string EncodePng(const PaletteImage& image) {
  const auto pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width <= 0 || image.height <= 0 || image.pixels.size() != pixels || image.palette.empty() ||
      image.palette.size() > 256) {
    throw std::runtime_error(fmt::format("cannot encode a {} x {} picture with {} pixels and {} colours", image.width,
                                         image.height, image.pixels.size(), image.palette.size()));
  }
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGBA_COLORMAP;
  header.colormap_entries = static_cast<png_uint_32>(image.palette.size());
  std::string bytes;
  // The first call only tells the size.
  for (int pass = 0; pass < 2; ++pass) {
    png_alloc_size_t size = bytes.size();
    const int ok = png_image_write_to_memory(&header, pass == 0 ? nullptr : bytes.data(), &size, 0, image.pixels.data(),
                                             image.width, image.palette.data());
    if (ok == 0) throw std::runtime_error(fmt::format("cannot encode a picture: {}", header.message));
    bytes.resize(size);
  }
  return bytes;
}

std::string Base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t have = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = (group << 8U) | (j < have ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    }
    for (std::size_t j = 0; j < 4; ++j) out += j <= have ? kDigits[(group >> (18 - 6 * j)) & 63U] : '=';
  }
  return out;
}

std::string PngDataUri(const PaletteImage& image) {
  return "data:image/png;base64," + Base64(EncodePng(image));
}

std::vector<std::array<std::uint8_t, 4>> GrayPalette() {
  std::vector<std::array<std::uint8_t, 4>> palette;
  for (int i = 0; i < 256; ++i) {
    const auto v = static_cast<std::uint8_t>(i);
    palette.push_back({v, v, v, 255});
  }
  return palette;
}

}  // namespace mapweld::report
