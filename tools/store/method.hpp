// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tools/merge/merge_config.hpp"

namespace mapweld::store {

// Names the way in which this program, with this configuration, searches a pair of drives: a hash of the program's own
// file and of every field of the configuration that may change a result. What another method found is never used.
std::uint64_t MethodOf(const merge::MergeConfig& config);

}  // namespace mapweld::store
