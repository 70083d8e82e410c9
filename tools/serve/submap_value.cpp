// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/submap_value.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "tools/merge/cosine_kernel.hpp"
#include "tools/merge/difference.hpp"

namespace mapweld::serve {
namespace {

constexpr double kOtherGroup = 2;
constexpr std::size_t kBestKeyframes = 8;  // a pair is judged by this many of its most alike keyframes

// How alike a keyframe is to the most alike one of the other drive: 0 nothing in common, 1 the same.
struct Likeness {
  std::vector<double> of_a;
  std::vector<double> of_b;
};

Likeness LikenessOf(const merge::Drive& a, const merge::Drive& b) {
  const merge::Cosines cosines = merge::ComputeCosines(a, b);
  Likeness likeness;
  likeness.of_a.assign(static_cast<std::size_t>(cosines.rows), 0);
  likeness.of_b.assign(static_cast<std::size_t>(cosines.cols), 0);
  std::size_t at = 0;
  for (double& row : likeness.of_a) {
    for (double& col : likeness.of_b) {
      const double alike = static_cast<double>(cosines.c[at++]) / merge::kCosineUnit;
      row = std::max(row, alike);
      col = std::max(col, alike);
    }
  }
  return likeness;
}

bool Wants(const merge::PairOutcome& pair) {
  return std::any_of(pair.asked.begin(), pair.asked.end(), [](const auto& asked) { return !asked.second; });
}

double MeanOfBest(std::vector<double> values) {
  const std::size_t n = std::min(values.size(), kBestKeyframes);
  if (n == 0) return 0;
  std::partial_sort(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), values.end(), std::greater<>());
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += values[i];
  return sum / static_cast<double>(n);
}

}  // namespace

std::vector<merge::SubmapKey> ByValue(const std::vector<merge::Drive>& drives, const merge::MergeResult& result,
                                      const merge::MergeCache& cache, merge::SubmapSource* submaps) {
  using Value = std::pair<double, double>;  // of the pair, of the keyframe in it
  std::map<merge::SubmapKey, Value> value;
  for (const merge::SubmapKey& key : result.missing) value[key] = {0, 0};
  if (value.empty()) return {};
  merge::PreparedCache prepared(submaps);
  for (int a = 0; a < static_cast<int>(drives.size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(drives.size()); ++b) {
      const auto pair = cache.FindPair(drives, a, b, &prepared);
      if (!pair.has_value() || !Wants(*pair)) continue;
      const Likeness likeness = LikenessOf(drives[static_cast<std::size_t>(a)], drives[static_cast<std::size_t>(b)]);
      const bool apart = result.group_of[static_cast<std::size_t>(a)] != result.group_of[static_cast<std::size_t>(b)];
      const double worth = MeanOfBest(likeness.of_a) * (apart ? kOtherGroup : 1);
      for (const auto& [key, found] : pair->asked) {
        const auto wanted = value.find(key);
        if (found || wanted == value.end()) continue;
        const auto keyframe = static_cast<std::size_t>(key.keyframe);
        wanted->second =
            std::max(wanted->second, Value(worth, (key.drive == a ? likeness.of_a : likeness.of_b)[keyframe]));
      }
    }
  }
  std::vector<merge::SubmapKey> order = result.missing;
  std::stable_sort(order.begin(), order.end(),
                   [&](const merge::SubmapKey& x, const merge::SubmapKey& y) { return value[x] > value[y]; });
  return order;
}

}  // namespace mapweld::serve
