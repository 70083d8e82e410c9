// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/merge_pipeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <random>
#include <set>
#include <stdexcept>

#include "tests/unit/tools/merge/synthetic_town.hpp"

namespace mapweld::merge {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Four drives. a and b share 130 m of Long Street, b against a. c is elsewhere, but at one place stands a copy of 25 m
// around a place that a passes: the look-alike. d begins where a ends.
class Fixture {
 public:
  static const Fixture& Get() {
    static const Fixture fixture;
    return fixture;
  }
  [[nodiscard]] std::vector<Drive> Drives() const {
    std::vector<Drive> out;
    for (const RecordedDrive& recorded : recorded_) out.push_back(recorded.drive);
    return out;
  }
  [[nodiscard]] const std::vector<RecordedDrive>& recorded() const { return recorded_; }
  [[nodiscard]] const std::vector<TownDrive>& drives() const { return drives_; }

 private:
  Fixture() : town_(11) {
    town_.AddStreet({-60, 0}, 600);
    town_.AddStreet({-60, 400}, 170);
    town_.AddStreet({160, 400}, 200);
    town_.Copy({60, 0}, 25, {75, 400});
    drives_.push_back(DriveAlong(town_, "a", 0, 220, 0, 1));
    drives_.push_back(DriveAlong(town_, "b", 330, 90, 0, 2));
    drives_.push_back(DriveAlong(town_, "c", -20, 320, 400, 3));
    drives_.push_back(DriveAlong(town_, "d", 223, 480, 0, 4));
    for (const TownDrive& drive : drives_) recorded_.push_back(BuildDrive(drive.recording, {}, nullptr));
  }
  SyntheticTown town_;
  std::vector<TownDrive> drives_;
  std::vector<RecordedDrive> recorded_;
};

// The result without its times, as text, to compare every bit.
std::string Bytes(const MergeResult& result) {
  std::string out;
  const auto add = [&](const void* data, std::size_t size) { out.append(static_cast<const char*>(data), size); };
  const auto add_pose = [&](const geom::Pose3& pose) {
    add(pose.t.data(), 3 * sizeof(double));
    add(pose.q.coeffs().data(), 4 * sizeof(double));
  };
  for (const Overlap& overlap : result.overlaps) {
    out += std::to_string(overlap.drive_a) + "-" + std::to_string(overlap.drive_b) + overlap.test;
    add(&overlap.weight, sizeof(double));
    add(&overlap.length_m, sizeof(double));
    add_pose(overlap.a_T_b);
    for (const auto& [a, b] : overlap.matches) out += std::to_string(a) + "," + std::to_string(b) + ";";
    for (const Loop& loop : overlap.loops) {
      out += std::to_string(loop.keyframe_a) + "," + std::to_string(loop.keyframe_b);
      add_pose(loop.a_T_b);
      add(&loop.weight, sizeof(double));
    }
  }
  for (const auto& group : result.groups) {
    for (const int drive : group) out += std::to_string(drive) + " ";
  }
  for (const auto& poses : result.merged_T_body) {
    for (const geom::Pose3& pose : poses) add_pose(pose);
  }
  for (const SubmapKey& key : result.missing) out += std::to_string(key.drive) + ":" + std::to_string(key.keyframe);
  for (const DifferenceMatrix& image : result.differences) add(image.distance.data(), image.distance.size());
  return out;
}

MergeResult MergeAll(const MergeConfig& config = {}, MergeCache* cache = nullptr) {
  RecordedSubmaps submaps(Fixture::Get().recorded());
  return MergeDrives(Fixture::Get().Drives(), submaps, config, nullptr, cache);
}

const MergeResult& Merged() {
  static const MergeResult result = MergeAll();
  return result;
}

const Overlap* Between(const MergeResult& result, int a, int b) {
  for (const Overlap& overlap : result.overlaps) {
    if (overlap.drive_a == a && overlap.drive_b == b) return &overlap;
  }
  return nullptr;
}

// The greatest distance between a merged keyframe and the truth, when drive `anchor` is laid on the truth at its start.
double WorstError(const MergeResult& result, int anchor, int drive) {
  const Fixture& fixture = Fixture::Get();
  const auto truth_of = [&](int d, std::size_t keyframe) {
    const RecordedDrive& recorded = fixture.recorded()[static_cast<std::size_t>(d)];
    const double path_m = recorded.drive.keyframes[keyframe].path_m;
    const auto scan = std::lower_bound(recorded.scan_path_m.begin(), recorded.scan_path_m.end(), path_m) -
                      recorded.scan_path_m.begin();
    return fixture.drives()[static_cast<std::size_t>(d)].truth[static_cast<std::size_t>(scan)];
  };
  const std::size_t middle = result.merged_T_body[static_cast<std::size_t>(anchor)].size() / 2;
  const geom::Pose3 truth_T_merged =
      truth_of(anchor, middle) * result.merged_T_body[static_cast<std::size_t>(anchor)][middle].Inverse();
  double worst = 0;
  const auto& poses = result.merged_T_body[static_cast<std::size_t>(drive)];
  for (std::size_t k = 0; k < poses.size(); ++k)
    worst = std::max(worst, (truth_T_merged * poses[k].t - truth_of(drive, k).t).norm());
  return worst;
}

TEST(MergeDrives, FindsTheOverlapOfDrivesInOppositeDirections) {
  const MergeResult& result = Merged();
  const Overlap* overlap = Between(result, 0, 1);
  ASSERT_NE(overlap, nullptr);
  EXPECT_TRUE(overlap->accepted) << overlap->test;
  EXPECT_TRUE(overlap->reverse);
  EXPECT_GT(overlap->length_m, 80);
  EXPECT_LT(overlap->length_m, 160);
  EXPECT_EQ(result.group_of[0], result.group_of[1]);
  EXPECT_LT(WorstError(result, 0, 1), 4.0);
}

TEST(MergeDrives, RefusesALookAlike) {
  const MergeResult& result = Merged();
  for (const Overlap& overlap : result.overlaps) {
    const bool with_c = overlap.drive_a == 2 || overlap.drive_b == 2;
    EXPECT_FALSE(with_c && overlap.accepted) << overlap.drive_a << "-" << overlap.drive_b;
    if (with_c) {
      EXPECT_FALSE(overlap.test.empty());
      EXPECT_EQ(overlap.weight, 0);
    }
  }
  EXPECT_NE(result.group_of[2], result.group_of[0]);
}

TEST(MergeDrives, KeepsADriveAloneInItsOwnFrame) {
  const MergeResult& result = Merged();
  const Drive c = Fixture::Get().Drives()[2];
  for (std::size_t k = 0; k < c.keyframes.size(); ++k) {
    EXPECT_EQ(result.merged_T_body[2][k].t, c.keyframes[k].odom_T_body.t);
  }
}

TEST(MergeDrives, GivesTheSameBytesForAnyNumberOfThreads) {
  MergeConfig one;
  one.threads = 1;
  MergeConfig five;
  five.threads = 5;
  EXPECT_EQ(Bytes(MergeAll(one)), Bytes(MergeAll(five)));
}

TEST(MergeDrives, GivesTheSameBytesWithACache) {
  MergeCache cache;
  const std::string without = Bytes(Merged());
  EXPECT_EQ(Bytes(MergeAll({}, &cache)), without);
  EXPECT_EQ(Bytes(MergeAll({}, &cache)), without);
}

TEST(MergeDrives, GivesTheSameBytesAfterGrowingWithACache) {
  std::vector<Drive> drives = Fixture::Get().Drives();
  std::vector<Drive> early = {drives[0], drives[1]};
  early[1].keyframes.resize(early[1].keyframes.size() / 2);
  RecordedSubmaps submaps(Fixture::Get().recorded());
  MergeCache cache;
  (void)MergeDrives(early, submaps, {}, nullptr, &cache);
  const MergeResult grown = MergeDrives(drives, submaps, {}, nullptr, &cache);
  EXPECT_EQ(Bytes(grown), Bytes(Merged()));
}

// The fixture's submaps for some of its drives.
class SubmapsOf : public SubmapSource {
 public:
  explicit SubmapsOf(std::vector<int> drives) : drives_(std::move(drives)) {}
  std::shared_ptr<const SubmapCloud> Find(SubmapKey key) override {
    return all_.Find({drives_[static_cast<std::size_t>(key.drive)], key.keyframe});
  }

 private:
  std::vector<int> drives_;
  RecordedSubmaps all_{Fixture::Get().recorded()};
};

// Drives come in a random order, in two pieces each, every arrival is merged on what the last merge left, by 1, 2 or 4
// threads: the last map is the same, bit for bit.
TEST(MergeDrives, GivesTheSameBytesForAnyOrderOfArrival) {
  const char* wanted = std::getenv("MAPWELD_ARRIVAL_ORDERS");
  const int orders = wanted != nullptr ? std::atoi(wanted) : 3;
  const std::vector<Drive> drives = Fixture::Get().Drives();
  for (int order = 0; order < orders; ++order) {
    std::vector<std::size_t> arrivals;
    for (std::size_t drive = 0; drive < drives.size(); ++drive) arrivals.insert(arrivals.end(), 2, drive);
    std::shuffle(arrivals.begin(), arrivals.end(), std::mt19937(static_cast<unsigned>(order)));
    MergeCache cache;
    std::map<std::size_t, int> pieces;
    MergeResult result;
    for (std::size_t i = 0; i < arrivals.size(); ++i) {
      ++pieces[arrivals[i]];
      std::vector<Drive> here;
      std::vector<int> index;
      for (const auto& [drive, count] : pieces) {
        here.push_back(drives[drive]);
        if (count == 1) here.back().keyframes.resize(here.back().keyframes.size() / 2);
        index.push_back(static_cast<int>(drive));
      }
      MergeConfig config;
      config.threads = std::array{1, 2, 4}[(i + static_cast<std::size_t>(order)) % 3];
      SubmapsOf submaps(index);
      result = MergeDrives(here, submaps, config, nullptr, &cache);
    }
    ASSERT_EQ(Bytes(result), Bytes(Merged())) << "order " << order;
  }
}

// A source that has only what it was given.
class PartialSubmaps : public SubmapSource {
 public:
  std::shared_ptr<const SubmapCloud> Find(SubmapKey key) override {
    return here.contains(key) ? all_.Find(key) : nullptr;
  }
  std::set<SubmapKey> here;

 private:
  RecordedSubmaps all_{Fixture::Get().recorded()};
};

TEST(MergeDrives, AsksForTheSubmapsItLacksAndEndsInAFewRounds) {
  PartialSubmaps submaps;
  MergeCache cache;
  const std::vector<Drive> drives = Fixture::Get().Drives();
  MergeResult result;
  int rounds = 0;
  do {
    result = MergeDrives(drives, submaps, {}, nullptr, &cache);
    if (rounds == 0) {
      EXPECT_FALSE(result.missing.empty());
      for (const Overlap& overlap : result.overlaps) EXPECT_FALSE(overlap.accepted);
    }
    EXPECT_TRUE(std::is_sorted(result.missing.begin(), result.missing.end()));
    submaps.here.insert(result.missing.begin(), result.missing.end());
    ++rounds;
  } while (!result.missing.empty() && rounds < 20);
  EXPECT_LE(rounds, 8);
  EXPECT_THAT(result.missing, IsEmpty());
  EXPECT_EQ(result.group_of[0], result.group_of[1]);
  EXPECT_NE(result.group_of[0], result.group_of[2]);
}

TEST(MergeDrives, NamesDrivesThatShareAName) {
  std::vector<Drive> drives(2);
  drives[0].name = drives[1].name = "bus";
  RecordedSubmaps submaps(Fixture::Get().recorded());
  try {
    (void)MergeDrives(drives, submaps, {}, nullptr);
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("'bus'"));
  }
}

TEST(MergeDrives, NamesAPoseThatIsNoPose) {
  std::vector<Drive> drives = {Fixture::Get().Drives()[0]};
  drives[0].keyframes[3].odom_T_body.q.coeffs().setZero();
  RecordedSubmaps submaps(Fixture::Get().recorded());
  try {
    (void)MergeDrives(drives, submaps, {}, nullptr);
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("keyframe 3"));
  }
}

TEST(MergeDrives, TakesEmptyAndTinyDrives) {
  std::vector<Drive> drives = Fixture::Get().Drives();
  drives.resize(1);
  drives.push_back({"nothing", {}});
  drives.push_back({"one", {drives[0].keyframes[0]}});
  RecordedSubmaps submaps(Fixture::Get().recorded());
  const MergeResult result = MergeDrives(drives, submaps, {}, nullptr);
  EXPECT_EQ(result.merged_T_body[1].size(), 0U);
  EXPECT_EQ(result.merged_T_body[2].size(), 1U);
  const MergeResult none = MergeDrives({}, submaps, {}, nullptr);
  EXPECT_THAT(none.groups, IsEmpty());
}

}  // namespace
}  // namespace mapweld::merge
