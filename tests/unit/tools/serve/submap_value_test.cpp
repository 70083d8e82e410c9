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
      for (std::size_t k = 0; k < 4; ++k) {
        place::PlaceDescriptor& of = DescriptorOf(d, k);
        of.scale = 0.01F;
        of.q[k == 3 ? 0 : 10 + 4 * static_cast<std::size_t>(d) + k] =
            100;  // only places number 3 have a part in common
      }
    }
    DescriptorOf(1, 3).q[1] = 40;
    DifferBy(600);
    result.group_of = {0, 1, 2};
    Pair(0, 1);
    Pair(0, 2);
    for (int d = 0; d < 3; ++d) {
      for (const int k : {0, 3}) result.missing.push_back({d, k});
    }
  }
  // How unlike drive 2 is at its keyframe 3, against 100 in common.
  void DifferBy(int part) {
    for (std::size_t i = 2; i < 8; ++i) DescriptorOf(2, 3).q[i] = static_cast<std::int8_t>(part / 6);
  }
  void Pair(int a, int b) {
    merge::PairOutcome outcome;
    outcome.overlap.drive_a = a;
    outcome.overlap.drive_b = b;
    for (const int d : {a, b}) {
      for (const int k : {0, 3}) outcome.asked[{d, k}] = false;
    }
    cache.StorePair(drives, outcome);
  }
  std::vector<merge::SubmapKey> Order() {
    NoSubmaps none;
    return ByValue(drives, result, cache, &none);
  }
  place::PlaceDescriptor& DescriptorOf(int drive, std::size_t keyframe) {
    return drives[static_cast<std::size_t>(drive)].keyframes[keyframe].place.descriptor;
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
  three.DifferBy(300);
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
