// SPDX-License-Identifier: Apache-2.0
// The keyframes of a recording or of an agent's log with one description per keyframe and descriptor.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/submap/submap.hpp"
#include "tools/describe/keyframe_source.hpp"
#include "tools/describe/place_table.hpp"
#include "tools/merge/progress.hpp"

namespace mapweld::describe {

// What a log holds already: the descriptors that the agent sent. Not a variant, since nothing can be described by it.
inline constexpr const char* kPublished = "published";

struct DescribedDrive {
  std::string name;
  std::vector<std::vector<PlaceRow>> variants;  // in the order asked for; one row per keyframe
  std::vector<int> refused;                     // per variant: keyframes without a description (scale 0)
  std::vector<int> unfamiliar;                  // per variant: described ones unlike what it was trained on
};

// Variants by name (variants.hpp), or kPublished for a log. Keyframes whose submap is missing stay without description.
// The result does not depend on the number of threads. Cost: that of the variants, per keyframe.
DescribedDrive DescribeKeyframes(const KeyframeSource& source, const std::vector<std::string>& variants, int threads,
                                 merge::Progress* progress);

// Throws std::runtime_error for a name that there is not, and for kPublished of what is no log. Ask before long work.
void CheckVariants(const std::filesystem::path& input, const std::vector<std::string>& variants);

// Points of a submap as the describers take them; those beyond its capacity are left out.
void FillSubmap(const std::vector<Eigen::Vector3f>& points, submap::Submap* submap);

}  // namespace mapweld::describe
