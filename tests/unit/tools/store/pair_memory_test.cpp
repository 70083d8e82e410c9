// SPDX-License-Identifier: Apache-2.0
// A drive that is added tomorrow is searched against the city, not the city against itself; and the merge is the same
// as one of everything at once.
#include "tools/store/pair_memory.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_directory.hpp"
#include "tests/unit/tools/merge/synthetic_town.hpp"
#include "tools/merge/merge_pipeline.hpp"

namespace mapweld::store {
namespace {

// Three drives along one street, which overlap one after the other.
const std::vector<merge::RecordedDrive>& Street() {
  static const std::vector<merge::RecordedDrive> drives = [] {
    merge::SyntheticTown town(5);
    town.AddStreet({0, 0}, 320);
    std::vector<merge::RecordedDrive> recorded;
    recorded.push_back(merge::BuildDrive(merge::DriveAlong(town, "a", 0, 180, 0, 1).recording, {}, nullptr));
    recorded.push_back(merge::BuildDrive(merge::DriveAlong(town, "b", 300, 60, 0, 2).recording, {}, nullptr));
    recorded.push_back(merge::BuildDrive(merge::DriveAlong(town, "c", 120, 320, 0, 3).recording, {}, nullptr));
    return recorded;
  }();
  return drives;
}

Bytes BytesOf(const std::vector<merge::Drive>& drives, const merge::MergeResult& result) {
  return Encode(ToRecord(drives, result, "", ""));
}

// A city of the first n drives, as `mapweld merge --store` does it.
class StreetInStore {
 public:
  explicit StreetInStore(const std::string& path) : city_(path) {}
  struct Outcome {
    Bytes bytes;
    int searched = 0;
    merge::MergeResult result;
  };
  Outcome Merge(std::size_t n) {
    std::vector<merge::Drive> drives;
    std::vector<DriveKey> keys;
    for (std::size_t d = 0; d < n; ++d) {
      const merge::RecordedDrive& recorded = Street()[d];
      auto known = city_.FindDrive(recorded.drive.name);
      if (!known.has_value()) {
        DriveInfo info;
        info.name = recorded.drive.name;
        known = StoredDrive{city_.AddDrive(info), info};
        for (std::size_t k = 0; k < recorded.drive.keyframes.size(); ++k) {
          city_.AddKeyframe(known->key, static_cast<std::int32_t>(k), recorded.drive.keyframes[k]);
          city_.AddSubmap(known->key, static_cast<std::int32_t>(k), Encode(recorded.submaps[k]));
        }
      }
      drives.push_back(city_.MergeDrive(*known));
      keys.push_back(known->key);
    }
    CitySubmaps submaps(&city_, keys);
    const merge::MergeConfig config;
    PairMemory memory(&city_, &drives, keys, &config);
    Outcome outcome;
    outcome.searched = memory.SearchUnknown(&submaps, nullptr);
    merge::MergeCache cache;
    memory.Fill(&cache, &submaps);
    outcome.result = merge::MergeDrives(drives, submaps, config, nullptr, &cache);
    NameRefusals(Rulings(&city_), drives, &outcome.result);
    outcome.bytes = BytesOf(drives, outcome.result);
    return outcome;
  }
  CityStore& city() { return city_; }

 private:
  CityStore city_;
};

TEST(PairMemory, SearchesOnlyWhatIsNewAndGivesTheSameBytes) {
  std::vector<merge::Drive> drives;
  for (const merge::RecordedDrive& recorded : Street()) drives.push_back(recorded.drive);
  merge::RecordedSubmaps submaps(Street());
  const merge::MergeResult at_once = merge::MergeDrives(drives, submaps, {}, nullptr);
  ASSERT_EQ(at_once.groups.size(), 1U) << "the street must be one group, or the test says little";

  const test::TemporaryDirectory directory;
  const std::string path = directory.File("city.db");
  EXPECT_EQ(StreetInStore(path).Merge(2).searched, 1);
  {
    StreetInStore tomorrow(path);
    const auto outcome = tomorrow.Merge(3);
    EXPECT_EQ(outcome.searched, 2) << "a and b are known";
    EXPECT_TRUE(outcome.bytes == BytesOf(drives, at_once));
  }
  const auto again = StreetInStore(path).Merge(3);
  EXPECT_EQ(again.searched, 0);
  EXPECT_TRUE(again.bytes == BytesOf(drives, at_once));
}

TEST(PairMemory, KeepsToWhatPeopleRefused) {
  const test::TemporaryDirectory directory;
  StreetInStore street(directory.File("city.db"));
  ASSERT_EQ(street.Merge(2).result.groups.size(), 1U);
  AddRuling(&street.city(), {Ruling::Kind::kRefusePair, "a", "b", "now"});
  const auto refused = street.Merge(2);
  EXPECT_EQ(refused.result.groups.size(), 2U);
  ASSERT_EQ(refused.result.overlaps.size(), 1U);
  EXPECT_FALSE(refused.result.overlaps[0].accepted);
  EXPECT_EQ(refused.result.overlaps[0].test, kByHand);
  RemoveRuling(&street.city(), {Ruling::Kind::kRefusePair, "a", "b", "now"});
  const auto released = street.Merge(2);
  EXPECT_EQ(released.result.groups.size(), 1U);
  EXPECT_EQ(released.searched, 0) << "what was found is still known";
}

}  // namespace
}  // namespace mapweld::store
