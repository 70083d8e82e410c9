// SPDX-License-Identifier: Apache-2.0
// One way to read a cloud, whatever its file type.
#pragma once

#include <filesystem>

#include "tools/io/point_cloud.hpp"

namespace mapweld::io {

// True for .bin (KITTI), .pcd and .ply, in any case of letters.
bool IsCloudFile(const std::filesystem::path& path);
// Chooses the reader by the extension.
PointCloud ReadCloud(const std::filesystem::path& path);

}  // namespace mapweld::io
