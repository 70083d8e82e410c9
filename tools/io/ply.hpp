// SPDX-License-Identifier: Apache-2.0
// Polygon File Format, the vertices only: ascii and binary_little_endian.
// Format: Greg Turk, "The PLY Polygon File Format", 1994.
#pragma once

#include <filesystem>

#include "tools/io/point_cloud.hpp"

namespace mapweld::io {

// Reads x y z, and intensity (or scalar_intensity) and red green blue where present. Faces and other elements after the
// vertices are left unread. Throws one sentence with the file and the line or offset.
PointCloud ReadPly(const std::filesystem::path& path);

// Writes x y z as float, and red green blue as uchar and intensity as float where the cloud has them.
void WritePly(const std::filesystem::path& path, const PointCloud& cloud, Encoding encoding = Encoding::kBinary);

}  // namespace mapweld::io
