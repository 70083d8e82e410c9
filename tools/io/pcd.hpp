// SPDX-License-Identifier: Apache-2.0
// Point Cloud Data files, version 0.7 (and older ones that keep its header): ascii, binary, binary_compressed.
// Format: https://pointclouds.org/documentation/tutorials/pcd_file_format.html
#pragma once

#include <filesystem>

#include "tools/io/point_cloud.hpp"

namespace mapweld::io {

// Reads x y z, and intensity and rgb (or rgba) where present; other fields are skipped. Points that are not numbers
// stay in, as PCD marks missing returns that way. Throws one sentence with the file and the line or offset.
PointCloud ReadPcd(const std::filesystem::path& path);

// Writes x y z, and rgb and intensity where the cloud has them.
void WritePcd(const std::filesystem::path& path, const PointCloud& cloud, Encoding encoding = Encoding::kBinary);

}  // namespace mapweld::io
