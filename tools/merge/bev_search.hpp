// SPDX-License-Identifier: Apache-2.0
// Where two submaps could lie on each other, without a first guess: correlation of their bird's-eye images over all
// headings and shifts, coarse (2 m cells, 5 deg) and then fine (1 m, 1.7 deg) around the best coarse peaks.
#pragma once

#include <vector>

#include "tools/merge/prepared_submap.hpp"

namespace mapweld::merge {

struct BevPeak {
  double x_m = 0;  // position of b in the level frame of a
  double y_m = 0;
  double yaw_rad = 0;
  double score = 0;  // how much of b stands where a stands too, 0..1 or so
};

// At most `most` peaks, best first, distinct by 4 m or 20 deg; shifts up to 24 m along each axis. Integer arithmetic:
// the same on every machine but for the rounding of sin and cos. Cost: about 5 ms.
std::vector<BevPeak> SearchBev(const PreparedSubmap& a, const PreparedSubmap& b, int most);

}  // namespace mapweld::merge
