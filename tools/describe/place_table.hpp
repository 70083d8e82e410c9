// SPDX-License-Identifier: Apache-2.0
// Descriptors of the keyframes of one recording as comma-separated text, one row each:
//   scan,x,y,z,scale,d0,...,d1023,o0,...,o191
// scan: index in the recording (of the keyframe, for a log of an agent). x, y, z: position in the frame of the
// recording's poses, m. Descriptor value i is scale * d_i; scale 0: no descriptor, matches nothing. o: signature.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geom/pose3.hpp"
#include "core/place/descriptor.hpp"

namespace mapweld::describe {

struct PlaceRow {
  int scan = 0;
  geom::Vec3d position;
  place::PlaceDescription place;
};

void WritePlaceTable(const std::filesystem::path& file, const std::vector<PlaceRow>& rows);

// Throws one sentence with file and line for anything but such a table with at least one row. The signature's scale is
// not in the table; it comes back as that of the descriptor.
std::vector<PlaceRow> ReadPlaceTable(const std::filesystem::path& file);

}  // namespace mapweld::describe
