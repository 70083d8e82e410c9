// SPDX-License-Identifier: Apache-2.0
#include "tools/io/cloud_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "tools/io/kitti.hpp"
#include "tools/io/pcd.hpp"
#include "tools/io/ply.hpp"

namespace mapweld::io {
namespace {

std::string LowerExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

}  // namespace

bool IsCloudFile(const std::filesystem::path& path) {
  const std::string extension = LowerExtension(path);
  return extension == ".bin" || extension == ".pcd" || extension == ".ply";
}

PointCloud ReadCloud(const std::filesystem::path& path) {
  const std::string extension = LowerExtension(path);
  if (extension == ".bin") return ReadKittiCloud(path);
  if (extension == ".pcd") return ReadPcd(path);
  if (extension == ".ply") return ReadPly(path);
  throw std::runtime_error(
      fmt::format("{} is no cloud that can be read; convert it to .pcd, .ply or KITTI .bin", path.string()));
}

}  // namespace mapweld::io
