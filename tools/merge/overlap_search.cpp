// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/overlap_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mapweld::merge {
namespace {

using geom::Pose3;

constexpr double kMinLength_m = 5;
constexpr std::size_t kPlacesCompared = 6;  // of an overlap, with other places of its drives

double Path(const Drive& drive, int keyframe) {
  return drive.keyframes[static_cast<std::size_t>(keyframe)].path_m;
}

double Horizontal(const Pose3& pose) {
  return pose.t.head<2>().norm();
}

// The keyframe step_m further along the drive, on the stride, or the last such one; the same keyframe when there is
// none at least half as far.
int StepAlong(const Drive& drive, int keyframe, int direction, const VerifyConfig& config) {
  int best = keyframe;
  const int count = static_cast<int>(drive.keyframes.size());
  for (int at = keyframe + direction; at >= 0 && at < count; at += direction) {
    if (at % config.keyframe_stride != 0) continue;
    best = at;
    if (std::abs(Path(drive, at) - Path(drive, keyframe)) >= config.step_m - 0.5) break;
  }
  return std::abs(Path(drive, best) - Path(drive, keyframe)) < 0.4 * config.step_m ? keyframe : best;
}

// One attempt of the walk.
struct Step {
  int a = 0;
  int b = 0;
  Pose3 predicted_a_T_b;
  double path_m = 0;  // of odometry behind the prediction
};

// Where the walk stands: at a loop, or at a pose carried on from one by odometry over doubt_m.
struct Stand {
  VerifiedLoop pose;
  double doubt_m = 0;
};

class Walk {
 public:
  Walk(LoopFinder* finder, const VerifyConfig& config) : finder_(finder), config_(&config) {}

  Hypothesis Run(const VerifiedLoop& seed) {
    out_.loops.push_back(seed);
    CountNear(seed);
    out_.evidence = seed.evidence;
    tried_.emplace_back(seed.a, seed.b);
    std::vector<Stand> open{{seed, 0}};
    for (std::size_t i = 0; i < open.size(); ++i) {
      const double doubt_m = open[i].doubt_m;
      if (doubt_m > config_->persist_m) continue;
      for (const Step& step : StepsFrom(open[i].pose)) Try(step, doubt_m + step.path_m, &open);
    }
    return std::move(out_);
  }

 private:
  std::vector<Step> StepsFrom(const VerifiedLoop& from) const {
    std::vector<Step> steps;
    for (const int direction : {1, -1}) {
      const int a = StepAlong(finder_->a(), from.a, direction, *config_);
      if (a != from.a) steps.push_back(Nearest(from, a, -1));
      const int b = StepAlong(finder_->b(), from.b, direction, *config_);
      if (b != from.b) steps.push_back(Nearest(from, -1, b));
    }
    return steps;
  }

  // One keyframe is given, the other (-1) is the nearest to it within a short path of the loop.
  Step Nearest(const VerifiedLoop& from, int a, int b) const {
    const bool choose_a = a < 0;
    const Drive& drive = choose_a ? finder_->a() : finder_->b();
    const int start = choose_a ? from.a : from.b;
    Step best;
    double best_m = std::numeric_limits<double>::infinity();
    for (int k = 0; k < static_cast<int>(drive.keyframes.size()); k += config_->keyframe_stride) {
      if (std::abs(Path(drive, k) - Path(drive, start)) > 3 * config_->step_m) continue;
      Step step{choose_a ? k : a, choose_a ? b : k, {}, 0};
      step.predicted_a_T_b = finder_->Predict(from, step.a, step.b);
      if (Horizontal(step.predicted_a_T_b) < best_m - 1e-9) {
        best_m = Horizontal(step.predicted_a_T_b);
        best = step;
      }
    }
    best.path_m = std::abs(Path(finder_->a(), best.a) - Path(finder_->a(), from.a)) +
                  std::abs(Path(finder_->b(), best.b) - Path(finder_->b(), from.b));
    return best;
  }

  bool WasTried(const Step& step) const {
    return std::any_of(tried_.begin(), tried_.end(), [&](const std::pair<int, int>& other) {
      return std::abs(Path(finder_->a(), step.a) - Path(finder_->a(), other.first)) < 0.6 * config_->step_m &&
             std::abs(Path(finder_->b(), step.b) - Path(finder_->b(), other.second)) < 0.6 * config_->step_m;
    });
  }

  // A look-alike agrees for a few steps, then the places differ while the odometries still run side by side. So the
  // walk goes on after a failure, to count how much of what should agree does not.
  void Try(const Step& step, double doubt_m, std::vector<Stand>* open) {
    const double distance_m = Horizontal(step.predicted_a_T_b);
    if (distance_m > config_->reach_m || WasTried(step)) return;
    tried_.emplace_back(step.a, step.b);
    if (!finder_->VolumesMeet(step.a, step.b, step.predicted_a_T_b)) return;
    const double slack_m = config_->max_jump_m + config_->drift * doubt_m;
    const LoopTry answer = finder_->Check(step.a, step.b, step.predicted_a_T_b, slack_m);
    const bool is_near = distance_m <= config_->near_m;
    VerifiedLoop predicted;
    predicted.a = step.a;
    predicted.b = step.b;
    predicted.a_T_b = step.predicted_a_T_b;
    switch (answer.answer) {
      case LoopTry::Answer::kMissing:
        ++out_.missing;
        if (is_near) open->push_back({predicted, 0});
        return;
      case LoopTry::Answer::kUnclear:
        if (is_near) open->push_back({answer.loop, doubt_m});
        return;
      case LoopTry::Answer::kSame:
        out_.loops.push_back(answer.loop);
        out_.evidence += answer.loop.evidence;
        if (is_near) CountNear(answer.loop);
        open->push_back({answer.loop, 0});
        return;
      case LoopTry::Answer::kDifferent:
        if (!is_near) return;
        CountNear(answer.loop);
        ++out_.contradictions;
        open->push_back({predicted, doubt_m});
        return;
    }
  }

  void CountNear(const VerifiedLoop& loop) {
    ++out_.near_pairs;
    out_.overlap += loop.overlap_ratio;
    out_.torn += loop.torn_share;
  }

  LoopFinder* finder_;
  const VerifyConfig* config_;
  Hypothesis out_;
  std::vector<std::pair<int, int>> tried_;
};

// Which of two refusals came further.
int Rank(const std::string& test) {
  constexpr const char* kOrder[] = {"no likeness",
                                    "registration",
                                    "little in common",
                                    "tilt",
                                    "overlap ratio",
                                    "slides along the street",
                                    "odometry",
                                    "contradiction",
                                    "torn",
                                    "little agreement",
                                    "too little evidence",
                                    "too few matches",
                                    "look-alike",
                                    "submaps missing"};
  const auto* at = std::find(std::begin(kOrder), std::end(kOrder), test);
  return static_cast<int>(at - std::begin(kOrder));
}

// Does the odometry of both drives allow both loops? Compared where the later one is.
bool OdometryAllows(const LoopFinder& finder, const VerifiedLoop& x, const VerifiedLoop& y,
                    const VerifyConfig& config) {
  const Pose3 off = finder.Predict(x, y.a, y.b).Inverse() * y.a_T_b;
  const double path_m =
      std::abs(Path(finder.a(), x.a) - Path(finder.a(), y.a)) + std::abs(Path(finder.b(), x.b) - Path(finder.b(), y.b));
  return off.t.norm() < 2 * config.max_jump_m + 2 * config.drift * path_m && geom::LogSo3(off.q).norm() < 0.35;
}

// Where drives only cross, the loops beside the crossing agree less than those at it, but of a true crossing not by
// much.
bool LoopsAgree(const VerifyConfig& config, const std::vector<VerifiedLoop>& loops) {
  double sum = 0;
  for (const VerifiedLoop& loop : loops) sum += loop.overlap_ratio;
  return sum >= config.min_mean_overlap * static_cast<double>(loops.size());
}

void Decide(const VerifyConfig& config, Hypothesis* hypothesis) {
  if (hypothesis->contradictions > config.max_contradiction * hypothesis->near_pairs) {
    hypothesis->test = "contradiction";
  } else if (hypothesis->torn > config.max_torn_share * hypothesis->near_pairs) {
    hypothesis->test = "torn";
  } else if (hypothesis->overlap < config.min_mean_overlap * hypothesis->near_pairs ||
             !LoopsAgree(config, hypothesis->loops)) {
    hypothesis->test = "little agreement";
  } else if (static_cast<int>(hypothesis->loops.size()) < config.min_loops) {
    hypothesis->test = hypothesis->missing > 0 ? "submaps missing" : "too few matches";
  } else if (hypothesis->evidence < config.min_total_evidence) {
    hypothesis->test = hypothesis->missing > 0 ? "submaps missing" : "too little evidence";
  }
}

bool Knows(const Hypothesis& hypothesis, const LoopFinder& finder, const Match& match, double step_m) {
  return std::any_of(hypothesis.loops.begin(), hypothesis.loops.end(), [&](const VerifiedLoop& loop) {
    return std::abs(Path(finder.a(), loop.a) - Path(finder.a(), match.a)) < step_m &&
           std::abs(Path(finder.b(), loop.b) - Path(finder.b(), match.b)) < step_m;
  });
}

}  // namespace

Hypothesis Extend(LoopFinder* finder, const VerifiedLoop& seed, const VerifyConfig& config) {
  Hypothesis out = Walk(finder, config).Run(seed);
  Decide(config, &out);
  return out;
}

bool StandsOut(const Hypothesis& hypothesis, LookAlikes* look_alikes, const VerifyConfig& config) {
  const double overlap_ratio = hypothesis.overlap / hypothesis.near_pairs;
  const std::vector<VerifiedLoop>& loops = hypothesis.loops;
  const std::size_t n = std::min(kPlacesCompared, loops.size());
  for (std::size_t i = 0; i < n; ++i) {
    const VerifiedLoop& loop = loops[i * loops.size() / n];
    if (overlap_ratio < look_alikes->Level(loop.a, loop.b) + config.min_above_look_alikes) return false;
  }
  return true;
}

Hypothesis FindOverlap(LoopFinder* finder, LookAlikes* look_alikes, const std::vector<Zone>& zones,
                       const VerifyConfig& config) {
  std::vector<Hypothesis> accepted;
  Hypothesis refused;
  refused.test = "no likeness";
  for (const Zone& zone : zones) {
    int tried = 0;
    for (const PlacedMatch& m : zone.matches) {
      if (tried >= config.seeds_per_zone && !m.match.ends) continue;
      const bool known = std::any_of(accepted.begin(), accepted.end(),
                                     [&](const Hypothesis& h) { return Knows(h, *finder, m.match, config.step_m); });
      if (known) break;
      ++tried;
      const LoopTry seed = finder->Search(m.match.a, m.match.b);
      Hypothesis hypothesis;
      if (seed.answer == LoopTry::Answer::kSame) {
        hypothesis = Extend(finder, seed.loop, config);
        if (hypothesis.test.empty() && !StandsOut(hypothesis, look_alikes, config)) hypothesis.test = "look-alike";
      } else {
        hypothesis.test = seed.test;
      }
      if (hypothesis.test.empty()) {
        accepted.push_back(std::move(hypothesis));
        break;
      }
      if (Rank(hypothesis.test) > Rank(refused.test)) refused = std::move(hypothesis);
    }
  }
  if (accepted.empty()) return refused;
  std::stable_sort(accepted.begin(), accepted.end(),
                   [](const Hypothesis& x, const Hypothesis& y) { return x.evidence > y.evidence; });
  Hypothesis out = std::move(accepted.front());
  for (std::size_t i = 1; i < accepted.size(); ++i) {
    Hypothesis& other = accepted[i];
    if (!OdometryAllows(*finder, out.loops.front(), other.loops.front(), config)) continue;
    for (const VerifiedLoop& loop : other.loops) {
      if (Knows(out, *finder, {loop.a, loop.b, 0, false, false, false}, 0.6 * config.step_m)) continue;
      out.loops.push_back(loop);
      out.evidence += loop.evidence;
    }
  }
  return out;
}

double SharedLength(const Drive& a, const std::vector<Loop>& loops, const VerifyConfig& config) {
  if (loops.empty()) return 0;
  std::vector<double> at_m;
  for (const Loop& loop : loops) {
    if (Horizontal(loop.a_T_b) <= config.near_m) at_m.push_back(Path(a, loop.keyframe_a));
  }
  std::sort(at_m.begin(), at_m.end());
  double length_m = 0;
  for (std::size_t i = 1; i < at_m.size(); ++i) {
    const double gap_m = at_m[i] - at_m[i - 1];
    if (gap_m < 2.5 * config.step_m) length_m += gap_m;
  }
  return std::max(kMinLength_m, length_m);
}

}  // namespace mapweld::merge
