// SPDX-License-Identifier: Apache-2.0
#include "tools/report/palette.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>

namespace mapweld::report {
namespace {

constexpr std::array<io::Rgb, kPaletteColors> kColors = {{
    {0xE6, 0x9F, 0x00},  // orange
    {0x56, 0xB4, 0xE9},  // sky blue
    {0xD5, 0x5E, 0x00},  // vermilion
    {0x00, 0x9E, 0x73},  // bluish green
    {0xCC, 0x79, 0xA7},  // reddish purple
    {0x3A, 0x7F, 0xD5},  // blue, lighter than theirs so that it shows on dark ground
    {0x9A, 0x8C, 0x6E},  // khaki
}};

}  // namespace

io::Rgb DriveColor(int drive) {
  return kColors[static_cast<std::size_t>(drive % kPaletteColors)];
}

std::string DriveColorHex(int drive) {
  const io::Rgb c = DriveColor(drive);
  return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
}

std::string DriveDashes(int drive, double width) {
  switch (drive / kPaletteColors % 3) {
    case 1:
      return fmt::format("{:.1f} {:.1f}", 4 * width, 2 * width);
    case 2:
      return fmt::format("{:.1f} {:.1f}", width, 1.5 * width);
    default:
      return "";
  }
}

}  // namespace mapweld::report
