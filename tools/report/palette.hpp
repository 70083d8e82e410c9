// SPDX-License-Identifier: Apache-2.0
// One colour per drive, the same in the point clouds and in the report. Seven hues that stay apart for all common forms
// of colour blindness and on light and dark ground (after Okabe and Ito, 2008, without yellow and black, which vanish
// on one of the two); with more drives the line style changes too.
#pragma once

#include <string>

#include "tools/io/point_cloud.hpp"

namespace mapweld::report {

inline constexpr int kPaletteColors = 7;

io::Rgb DriveColor(int drive);
// "#rrggbb"
std::string DriveColorHex(int drive);
// SVG stroke-dasharray for a line of `width`; empty for a solid line. Changes after every kPaletteColors drives.
std::string DriveDashes(int drive, double width);

}  // namespace mapweld::report
