// SPDX-License-Identifier: Apache-2.0
// The merge, from drives to groups with merged poses. merge_pipeline.cpp is the place to read what the host does.
#pragma once

#include <vector>

#include "tools/merge/crew.hpp"
#include "tools/merge/drive.hpp"
#include "tools/merge/merge_cache.hpp"
#include "tools/merge/merge_config.hpp"
#include "tools/merge/merge_result.hpp"
#include "tools/merge/progress.hpp"

namespace mapweld::merge {

// A pure function of drives, submaps and config, but for MergeResult::times: any crew and any cache give the same
// bytes. Drives sorted by name give a result that does not depend on the order in which they arrived. Submaps that the
// source lacks are listed in `missing`; what they would have shown counts as not seen. Fetching them and merging again
// comes to an end after a few rounds. Throws std::runtime_error for drives that share a name or have a pose that is not
// a rigid transform. The cache may be null.
MergeResult MergeDrives(const std::vector<Drive>& drives, SubmapSource& submaps, const MergeConfig& config, Crew& crew,
                        MergeCache* cache = nullptr);
// With config.threads threads of this process. progress may be null.
MergeResult MergeDrives(const std::vector<Drive>& drives, SubmapSource& submaps, const MergeConfig& config,
                        Progress* progress, MergeCache* cache = nullptr);

}  // namespace mapweld::merge
