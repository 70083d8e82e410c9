// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/merge/sequence_match.hpp"

namespace mapweld::merge {

// All candidates for one pair of drives: lines of matches, single matches, and the four meetings of their ends (drives
// begin where others ended, and fleets start from one yard), in this order and without repetition.
std::vector<Match> Associate(const Distances& distances, const AssociationConfig& config);

}  // namespace mapweld::merge
