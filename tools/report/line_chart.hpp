// SPDX-License-Identifier: Apache-2.0
// Curves over common axes as a picture of its own: for documents and for people who would rather look than read.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace mapweld::report {

struct Series {
  std::string name;
  std::vector<std::array<double, 2>> points;  // x, y; drawn in this order
};

struct Axis {
  std::string label;
  double from = 0;
  double to = 1;
  double tick = 0.2;
};

struct LineChart {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Series> series;
  bool marks = false;  // a dot at every point
};

// Several charts side by side, with one key under all of them: the series of each chart must have the same names in the
// same order. Points outside the axes are drawn at their edge. Throws when no chart is given.
std::string ChartsSvg(const std::vector<LineChart>& charts);

// Writes FILE.svg, and FILE.png beside it when the program rsvg-convert is installed. Returns a sentence to show when
// it is not, else nothing.
std::string WriteCharts(const std::filesystem::path& without_extension, const std::vector<LineChart>& charts);

}  // namespace mapweld::report
