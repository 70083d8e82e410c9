// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/look_alikes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "core/place/descriptor.hpp"

namespace mapweld::merge {
namespace {

constexpr std::size_t kCandidates = 4;
constexpr double kOtherPlace_m = 60;   // of path, from one place to the next
constexpr double kBetweenThem_m = 15;  // of path, from one candidate to the next
constexpr double kSamePlace_m = 10;    // closer to where odometry has it, it is no look-alike

double PathBetween(const Drive& drive, int x, int y) {
  return std::abs(drive.keyframes[static_cast<std::size_t>(x)].path_m -
                  drive.keyframes[static_cast<std::size_t>(y)].path_m);
}

// The other places of the drive that are most like this one, by descriptor.
std::vector<int> MostAlike(const Drive& drive, int keyframe, int stride) {
  const auto descriptor = [&](int k) -> const place::PlaceDescriptor& {
    return drive.keyframes[static_cast<std::size_t>(k)].place.descriptor;
  };
  std::vector<std::pair<float, int>> by_distance;
  for (int k = 0; k < static_cast<int>(drive.keyframes.size()); k += stride) {
    if (PathBetween(drive, keyframe, k) < kOtherPlace_m) continue;
    by_distance.emplace_back(place::CosineDistance(descriptor(keyframe), descriptor(k)), k);
  }
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<int> out;
  for (const auto& [distance, k] : by_distance) {
    const bool apart = std::all_of(out.begin(), out.end(),
                                   [&, at = k](int other) { return PathBetween(drive, at, other) >= kBetweenThem_m; });
    if (apart) out.push_back(k);
    if (out.size() == kCandidates) break;
  }
  return out;
}

}  // namespace

LookAlikes::LookAlikes(const Drive& a, int index_a, const Drive& b, int index_b, PreparedCache* submaps,
                       const MergeConfig& config)
    : a_{LoopFinder(a, index_a, a, index_a, submaps, config), {}},
      b_{LoopFinder(b, index_b, b, index_b, submaps, config), {}},
      config_(config.verify) {}

double LookAlikes::Level(int keyframe_a, int keyframe_b) {
  return std::max(LevelIn(&a_, keyframe_a, config_), LevelIn(&b_, keyframe_b, config_));
}

double LookAlikes::LevelIn(Own* own, int keyframe, const VerifyConfig& config) {
  const auto [at, is_new] = own->level.emplace(keyframe, 0);
  if (!is_new) return at->second;
  const Drive& drive = own->finder.a();
  for (const int other : MostAlike(drive, keyframe, config.keyframe_stride)) {
    const LoopTry found = own->finder.Search(keyframe, other);
    if (!found.comparable) continue;
    const geom::Pose3 by_odometry = own->finder.LevelA(keyframe).Inverse() * own->finder.LevelA(other);
    const double slack_m = kSamePlace_m + config.drift * PathBetween(drive, keyframe, other);
    if ((by_odometry.t - found.loop.a_T_b.t).norm() < slack_m) continue;
    at->second = std::max(at->second, found.loop.overlap_ratio);
  }
  return at->second;
}

std::map<SubmapKey, bool> LookAlikes::asked() const {
  std::map<SubmapKey, bool> out = a_.finder.asked();
  out.insert(b_.finder.asked().begin(), b_.finder.asked().end());
  return out;
}

}  // namespace mapweld::merge
