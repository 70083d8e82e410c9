// SPDX-License-Identifier: Apache-2.0
// Finds the clouds of a recording and puts them in the order in which they were recorded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/time.hpp"

namespace mapweld::io {

struct CloudListing {
  std::filesystem::path folder;
  std::vector<std::filesystem::path> files;
  // What the names say, for all files or for none: frame numbers, or times as written with their unit unknown.
  std::vector<std::int64_t> numbers;
  std::vector<std::string> stamps;
};

// Looks into the usual sub-folders (velodyne, clouds, scans, ...), then into `recording` itself; the first one that
// holds clouds counts. Names that are times are sorted by time, others so that cloud_9 comes before cloud_10. Throws
// when there is no such folder or when no folder has a cloud.
CloudListing ListClouds(const std::filesystem::path& recording);

// The times that the names stand for. A name does not say whether it counts seconds, milli-, micro- or nanoseconds: the
// unit is the one that puts most scans between `first` and `last`. Nothing when no unit puts any there.
std::optional<std::vector<TimeNs>> TimesFromNames(const CloudListing& listing, TimeNs first, TimeNs last);

}  // namespace mapweld::io
