// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/submap_value.hpp"

#include <gtest/gtest.h>

#include "tools/merge/merge_cache.hpp"

namespace mapweld::serve {
namespace {

class NoSubmaps final : public merge::SubmapSource {
 public:
  std::shared_ptr<const merge::SubmapCloud> Find(merge::SubmapKey) override { return nullptr; }
};

// Three drives of four keyframes: 0 and 1 are alike in one place, 0 and 2 hardly; every pair wants two submaps of each.
class ThreeDrives {
 public:
  ThreeDrives() : drives(3) {
    for (int d = 0; d < 3; ++d) {
      drives[static_cast<std::size_t>(d)].name = std::string(1, static_cast<char>('a' + d));
      drives[static_cast<std::size_t>(d)].keyframes.resize(4);
    }
    result.group_of = {0, 1, 2};
    Pair(0, 1, 20);
    Pair(0, 2, 220);
    for (int d = 0; d < 3; ++d) {
      for (const int k : {0, 3}) result.missing.push_back({d, k});
    }
  }
  // `distance` between keyframe 3 of both, 250 elsewhere.
  void Pair(int a, int b, std::uint8_t distance) {
    merge::PairOutcome outcome;
    outcome.overlap.drive_a = a;
    outcome.overlap.drive_b = b;
    outcome.difference = {a, b, 4, 4, std::vector<std::uint8_t>(16, 250)};
    outcome.difference.distance[15] = distance;
    for (const int d : {a, b}) {
      for (const int k : {0, 3}) outcome.asked[{d, k}] = false;
    }
    cache.StorePair(drives, outcome);
  }
  std::vector<merge::SubmapKey> Order() {
    NoSubmaps none;
    return ByValue(drives, result, cache, &none);
  }
  std::vector<merge::Drive> drives;
  merge::MergeResult result;
  merge::MergeCache cache;
};

TEST(ByValue, TheMostAlikePlacesOfTheMostAlikeDrivesComeFirst) {
  ThreeDrives three;
  const std::vector<merge::SubmapKey> order = three.Order();
  const std::vector<merge::SubmapKey> expected = {{0, 3}, {1, 3}, {0, 0}, {1, 0}, {2, 3}, {2, 0}};
  EXPECT_EQ(order, expected);
}

TEST(ByValue, APairThatIsNotYetOneGroupComesBeforeOneThatIs) {
  ThreeDrives three;
  three.Pair(0, 2, 100);
  three.result.group_of = {0, 0, 1};
  const std::vector<merge::SubmapKey> order = three.Order();
  EXPECT_EQ(order.front(), (merge::SubmapKey{0, 3}));
  EXPECT_EQ(order[1], (merge::SubmapKey{2, 3})) << "less alike, but a group is to be won";
}

TEST(ByValue, LosesNothingThatNoPairSearchWants) {
  ThreeDrives three;
  three.result.missing.push_back({2, 1});
  const std::vector<merge::SubmapKey> order = three.Order();
  EXPECT_EQ(order.size(), 7U);
  EXPECT_EQ(order.back(), (merge::SubmapKey{2, 1}));
}

}  // namespace
}  // namespace mapweld::serve
