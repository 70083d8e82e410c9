// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/association.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/city_descriptors.hpp"

namespace mapweld::merge {
namespace {

std::vector<DrivePlaces> PlacesOf(const std::vector<Drive>& drives) {
  std::vector<DrivePlaces> out;
  for (const Drive& drive : drives) out.push_back(CollectPlaces(drive));
  return out;
}

// Keyframes of a that come within distance_m of b.
int Shared(const Drive& a, const Drive& b, double distance_m) {
  return static_cast<int>(std::count_if(a.keyframes.begin(), a.keyframes.end(), [&](const Keyframe& x) {
    return std::any_of(b.keyframes.begin(), b.keyframes.end(),
                       [&](const Keyframe& y) { return (x.odom_T_body.t - y.odom_T_body.t).norm() < distance_m; });
  }));
}

TEST(Sketches, FindEveryPairOfDrivesWithACommonStreetAndDropMostOthers) {
  test::CityDescriptorsConfig town;
  town.drives = 24;
  town.keyframes = 200;
  town.blocks = 16;
  const std::vector<Drive> drives = test::CityDescriptors(town).Make();
  const std::vector<DrivePlaces> places = PlacesOf(drives);
  int overlapping = 0;
  int unrelated = 0;
  int passed = 0;
  for (std::size_t a = 0; a < drives.size(); ++a) {
    for (std::size_t b = a + 1; b < drives.size(); ++b) {
      Evidence evidence;
      const bool agrees = SketchesAgree(places[a], places[b], {}, &evidence);
      const int shared = Shared(drives[a], drives[b], 4);
      if (shared >= 12) {
        ++overlapping;
        EXPECT_TRUE(agrees) << a << "-" << b << ": " << shared << " keyframes, sequence " << evidence.sequence;
      } else if (Shared(drives[a], drives[b], 30) == 0) {
        ++unrelated;
        passed += agrees ? 1 : 0;
      }
    }
  }
  EXPECT_GT(overlapping, 20);
  EXPECT_GT(unrelated, 50);
  EXPECT_LT(passed, unrelated / 10);
}

TEST(Sketches, DoNotDecideForDrivesTooShortToSay) {
  test::CityDescriptorsConfig town;
  town.drives = 2;
  town.keyframes = 6;
  const std::vector<DrivePlaces> places = PlacesOf(test::CityDescriptors(town).Make());
  Evidence evidence;
  EXPECT_TRUE(SketchesAgree(places[0], places[1], {}, &evidence));
}

TEST(Association, ProposesNothingForDrivesOfDifferentTowns) {
  test::CityDescriptorsConfig here;
  here.drives = 12;
  here.keyframes = 150;
  test::CityDescriptorsConfig there = here;
  there.seed = 2;  // other waves: another world
  const std::vector<DrivePlaces> a = PlacesOf(test::CityDescriptors(here).Make());
  const std::vector<DrivePlaces> b = PlacesOf(test::CityDescriptors(there).Make());
  int compared = 0;
  for (const DrivePlaces& x : a) {
    for (const DrivePlaces& y : b) compared += Associate(x, y, {.sketches = true}).compared ? 1 : 0;
  }
  EXPECT_LT(compared, 144 / 10);
}

TEST(Association, OfEmptyDrivesIsNothing) {
  const DrivePlaces nothing = CollectPlaces(Drive{});
  EXPECT_TRUE(Associate(nothing, nothing, {}).matches.empty());
}

TEST(Association, ComparesAllUnlessAskedForSketches) {
  test::CityDescriptorsConfig town;
  town.drives = 2;
  town.keyframes = 40;
  town.blocks = 1000;
  const std::vector<DrivePlaces> places = PlacesOf(test::CityDescriptors(town).Make());
  EXPECT_TRUE(Associate(places[0], places[1], {}).compared);
  EXPECT_FALSE(Associate(places[0], places[1], {.sketches = true}).compared);
}

}  // namespace
}  // namespace mapweld::merge
