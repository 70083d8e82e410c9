// SPDX-License-Identifier: Apache-2.0
// Tries pairs of keyframes of two drives: do their submaps show the same place, and how do they lie to each other?
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/geom/convex_overlap.hpp"
#include "tools/merge/merge_config.hpp"
#include "tools/merge/prepared_cache.hpp"

namespace mapweld::merge {

// A pair of keyframes that passed every test of one pair.
struct VerifiedLoop {
  int a = 0;
  int b = 0;
  geom::Pose3 a_T_b;  // level frames
  double evidence = 0;
  double overlap_ratio = 0;
  double residual_m = 0;
  double torn_share = 1;  // see Registration
};

struct LoopTry {
  // kUnclear: nothing speaks against it, but it could as well lie a few metres further along the street.
  enum class Answer { kSame, kUnclear, kDifferent, kMissing };
  Answer answer = Answer::kDifferent;
  const char* test = "";    // that refused it
  VerifiedLoop loop;        // the pose is set unless kMissing, even when refused
  bool comparable = false;  // registered, level and with enough in common: the loop's numbers mean something
};

class LoopFinder {
 public:
  LoopFinder(const Drive& a, int index_a, const Drive& b, int index_b, PreparedCache* submaps,
             const MergeConfig& config);

  // Without a first guess of the relative pose.
  LoopTry Search(int a, int b);
  // Near a predicted relative pose; `slack_m` is how far off the prediction may be.
  LoopTry Check(int a, int b, const geom::Pose3& predicted_a_T_b, double slack_m);
  // Do the volumes that the two submaps fill meet, at this pose? True for missing ones.
  bool VolumesMeet(int a, int b, const geom::Pose3& a_T_b);

  [[nodiscard]] const Drive& a() const { return *a_; }
  [[nodiscard]] const Drive& b() const { return *b_; }
  [[nodiscard]] const geom::Pose3& LevelA(int keyframe) const { return level_a_[static_cast<std::size_t>(keyframe)]; }
  [[nodiscard]] const geom::Pose3& LevelB(int keyframe) const { return level_b_[static_cast<std::size_t>(keyframe)]; }
  // The pose of (to_a, to_b) by odometry from a loop at another pair.
  [[nodiscard]] geom::Pose3 Predict(const VerifiedLoop& from, int to_a, int to_b) const;

  // Every submap asked for, and whether it was there.
  [[nodiscard]] const std::map<SubmapKey, bool>& asked() const { return asked_; }

 private:
  std::shared_ptr<const PreparedSubmap> Submap(SubmapKey key);
  LoopTry Judge(int a, int b, const Registration& registration, double least_evidence) const;

  const Drive* a_;
  const Drive* b_;
  int index_a_;
  int index_b_;
  PreparedCache* submaps_;
  const MergeConfig* config_;
  std::vector<geom::Pose3> level_a_;  // odom_T_level
  std::vector<geom::Pose3> level_b_;
  std::map<SubmapKey, bool> asked_;
};

}  // namespace mapweld::merge
