// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/growth_study.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "tools/eval/place_set.hpp"
#include "tools/eval/trajectory_error.hpp"
#include "tools/merge/merge_pipeline.hpp"

namespace mapweld::eval {
namespace {

using describe::KeyframeSource;
constexpr double kMeet_m = 10;
constexpr double kShared_m = 30;

class SourceSubmaps final : public merge::SubmapSource {
 public:
  explicit SourceSubmaps(const std::vector<KeyframeSource>& sources) : sources_(&sources) {}
  std::shared_ptr<const merge::SubmapCloud> Find(merge::SubmapKey key) override {
    return (*sources_)[static_cast<std::size_t>(key.drive)].submap(key.keyframe);
  }

 private:
  const std::vector<KeyframeSource>* sources_;
};

enum class Meeting { kNone, kCrossing, kOverlap };

// From true positions: how much of a's path has a keyframe of b within 10 m, in the same or the opposite direction.
Meeting MeetingOf(const KeyframeSource& a, std::size_t a_count, const KeyframeSource& b, std::size_t b_count) {
  if (a_count < 3 || b_count < 3) return Meeting::kNone;
  PlaceSet set;
  const auto first = [](const KeyframeSource& source, std::size_t count) {
    return std::vector<geom::Vec3d>(source.positions.begin(),
                                    source.positions.begin() + static_cast<std::ptrdiff_t>(count));
  };
  set.AddSession(a.drive.name, first(a, a_count));
  set.AddSession(b.drive.name, first(b, b_count));
  Meeting meeting = Meeting::kNone;
  double shared_m = 0;
  for (int i = 0; i < static_cast<int>(a_count); ++i) {
    bool along = false;
    for (int j = static_cast<int>(a_count); j < set.size(); ++j) {
      if (set.Metres(i, j) > kMeet_m) continue;
      meeting = Meeting::kCrossing;
      along = along || set.DirectionBetween(i, j) != Direction::kCrossing;
    }
    if (along && i > 0) shared_m += (set.Position(i) - set.Position(i - 1)).norm();
  }
  return shared_m >= kShared_m ? Meeting::kOverlap : meeting;
}

// The smallest drive that each is connected with.
std::vector<int> Zones(const std::vector<std::vector<Meeting>>& meetings) {
  std::vector<int> zone(meetings.size());
  std::iota(zone.begin(), zone.end(), 0);
  for (std::size_t a = 0; a < meetings.size(); ++a) {
    for (std::size_t b = a + 1; b < meetings.size(); ++b) {
      if (meetings[a][b] == Meeting::kNone) continue;
      const int from = std::max(zone[a], zone[b]);
      const int to = std::min(zone[a], zone[b]);
      std::replace(zone.begin(), zone.end(), from, to);
    }
  }
  return zone;
}

double Rmse(const std::vector<KeyframeSource>& sources, const std::vector<merge::Drive>& drives,
            const merge::MergeResult& result) {
  double squares = 0;
  std::size_t poses = 0;
  for (const std::vector<int>& group : result.groups) {
    std::vector<Vehicle> vehicles;
    for (const int drive : group) {
      const auto d = static_cast<std::size_t>(drive);
      Vehicle vehicle{drives[d].name, {}, {}};
      for (std::size_t k = 0; k < drives[d].keyframes.size(); ++k) {
        const TimeNs t = drives[d].keyframes[k].t;
        vehicle.truth.push_back({t, {sources[d].positions[k], geom::Quatd::Identity()}});
        vehicle.estimate.push_back({t, result.merged_T_body[d][k]});
      }
      if (!vehicle.truth.empty()) vehicles.push_back(std::move(vehicle));
    }
    if (vehicles.empty()) continue;
    const ErrorStatistics all = EvaluateGroup(vehicles).all;
    squares += all.rmse_m * all.rmse_m * static_cast<double>(all.count);
    poses += all.count;
  }
  return poses > 0 ? std::sqrt(squares / static_cast<double>(poses)) : 0;
}

void CompareWithTruth(const std::vector<KeyframeSource>& sources, const std::vector<merge::Drive>& drives,
                      const merge::MergeResult& result, GrowthStep* step) {
  std::vector<std::vector<Meeting>> meetings(drives.size(), std::vector<Meeting>(drives.size(), Meeting::kNone));
  for (std::size_t a = 0; a < drives.size(); ++a) {
    for (std::size_t b = a + 1; b < drives.size(); ++b) {
      meetings[a][b] = MeetingOf(sources[a], drives[a].keyframes.size(), sources[b], drives[b].keyframes.size());
      step->overlaps += meetings[a][b] == Meeting::kOverlap ? 1 : 0;
    }
  }
  for (const merge::Overlap& overlap : result.overlaps) {
    if (!overlap.accepted) continue;
    const Meeting meeting =
        meetings[static_cast<std::size_t>(overlap.drive_a)][static_cast<std::size_t>(overlap.drive_b)];
    ++step->accepted;
    step->wrong += meeting == Meeting::kNone ? 1 : 0;
    step->found += meeting == Meeting::kOverlap ? 1 : 0;
  }
  const std::vector<int> zones = Zones(meetings);
  for (std::size_t d = 0; d < zones.size(); ++d) step->zones += zones[d] == static_cast<int>(d) ? 1 : 0;
  for (const std::vector<int>& group : result.groups) {
    const auto zone_of = [&](int drive) { return zones[static_cast<std::size_t>(drive)]; };
    step->mixed_groups +=
        std::any_of(group.begin(), group.end(), [&](int d) { return zone_of(d) != zone_of(group.front()); }) ? 1 : 0;
  }
}

}  // namespace

std::vector<GrowthStep> StudyGrowth(const std::vector<KeyframeSource>& sources, const std::vector<double>& lengths_m,
                                    int threads, merge::Progress* progress) {
  std::vector<GrowthStep> steps;
  SourceSubmaps submaps(sources);
  for (const double longest_m : lengths_m) {
    GrowthStep step;
    step.longest_m = longest_m;
    std::vector<merge::Drive> drives;
    for (const KeyframeSource& source : sources) {
      merge::Drive drive{source.drive.name, {}};
      for (const merge::Keyframe& keyframe : source.drive.keyframes) {
        if (keyframe.path_m <= longest_m) drive.keyframes.push_back(keyframe);
      }
      step.keyframes += static_cast<int>(drive.keyframes.size());
      if (!drive.keyframes.empty()) step.path_km += drive.keyframes.back().path_m / 1000;
      drives.push_back(std::move(drive));
    }
    merge::MergeConfig config;
    config.threads = threads;
    const auto begin = std::chrono::steady_clock::now();
    const merge::MergeResult result = merge::MergeDrives(drives, submaps, config, progress);
    step.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    step.stages = result.times;
    step.groups = static_cast<int>(result.groups.size());
    step.rmse_m = Rmse(sources, drives, result);
    CompareWithTruth(sources, drives, result, &step);
    steps.push_back(std::move(step));
  }
  return steps;
}

}  // namespace mapweld::eval
