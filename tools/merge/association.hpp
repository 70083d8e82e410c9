// SPDX-License-Identifier: Apache-2.0
// Which keyframes of two drives could show the same place. A pair of drives is first compared by sketches; only one in
// which a line or an entry stands out is compared in full.
#pragma once

#include <vector>

#include "tools/merge/sequence_match.hpp"
#include "tools/merge/sketch.hpp"

namespace mapweld::merge {

// What all pairs of a drive share.
struct DrivePlaces {
  DescriptorSet descriptors;
  std::vector<Sketch> sketches;
};
DrivePlaces CollectPlaces(const Drive& drive);

struct Association {
  std::vector<Match> matches;  // lines, then single keyframes, then meetings of the drives' ends; none twice
  Evidence evidence;           // of the comparison that decided
  bool compared = false;       // in full
};

// No matches: nothing speaks for a common place. Cost for drives of m and n keyframes: about 5 ns x mn for the
// sketches, 20 ns x mn more for a pair that is compared in full.
Association Associate(const DrivePlaces& a, const DrivePlaces& b, const AssociationConfig& config);

// Are the sketches alike enough for a full comparison? Always true for drives too short to say.
bool SketchesAgree(const DrivePlaces& a, const DrivePlaces& b, const AssociationConfig& config, Evidence* evidence);

// All candidates of a likeness matrix.
std::vector<Match> ProposeMatches(const Likeness& likeness, const AssociationConfig& config);

}  // namespace mapweld::merge
