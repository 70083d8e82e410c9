// SPDX-License-Identifier: Apache-2.0
// The keyframes of a recording or of an agent's log, as the merge makes them, with one description per keyframe and
// descriptor.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "core/geom/pose3.hpp"
#include "core/place/descriptor.hpp"
#include "tools/describe/place_table.hpp"
#include "tools/merge/progress.hpp"

namespace mapweld::describe {

// What a log holds already: the descriptors that the agent sent. Not a variant, since nothing can be described by it.
inline constexpr const char* kPublished = "published";

struct DescribedDrive {
  std::string name;
  std::vector<TimeNs> times;                    // per keyframe
  std::vector<std::vector<PlaceRow>> variants;  // in the order asked for; one row per keyframe
  std::vector<int> refused;                     // per variant: keyframes without a description (scale 0)
};

// `path` is a folder with scans and poses (tools/io/recording_folder.hpp) or an LCM log of agents, which may hold
// several drives. Variants by name (variants.hpp), or kPublished for a log. Keyframes whose submap is not in the log
// stay without description. Throws std::runtime_error naming the input. The result does not depend on the number of
// threads. Cost: about 10 ms a keyframe for reading scans and building submaps, and each variant's own.
std::vector<DescribedDrive> DescribeDrives(const std::filesystem::path& path, const std::vector<std::string>& variants,
                                           int threads, merge::Progress* progress);

}  // namespace mapweld::describe
