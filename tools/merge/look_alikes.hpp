// SPDX-License-Identifier: Apache-2.0
// How much different places of one world resemble each other: along equal houses a lot, elsewhere little. Two drives
// share a place only if they agree by clearly more than that. It is measured, not assumed: places of one drive that
// odometry knows to be different are registered onto each other.
#pragma once

#include <map>
#include <utility>

#include "tools/merge/loop_finder.hpp"

namespace mapweld::merge {

// Of one pair of drives. Not safe for several threads.
class LookAlikes {
 public:
  LookAlikes(const Drive& a, int index_a, const Drive& b, int index_b, PreparedCache* submaps,
             const MergeConfig& config);

  // The greatest overlap ratio that the place of either keyframe reaches elsewhere in its own drive, among the places
  // there whose descriptors are most like its own. 0 when there is no other place. Cost: about 100 ms at first, then
  // remembered per keyframe.
  [[nodiscard]] double Level(int keyframe_a, int keyframe_b);

  // Every submap asked for, and whether it was there.
  [[nodiscard]] std::map<SubmapKey, bool> asked() const;

 private:
  struct Own {
    LoopFinder finder;  // of the drive with itself
    std::map<int, double> level;
  };
  static double LevelIn(Own* own, int keyframe, const VerifyConfig& config);

  Own a_;
  Own b_;
  VerifyConfig config_;
};

}  // namespace mapweld::merge
