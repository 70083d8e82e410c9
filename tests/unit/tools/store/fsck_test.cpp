// SPDX-License-Identifier: Apache-2.0
#include "tools/store/fsck.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "tests/support/crash_disk.hpp"
#include "tests/support/small_city.hpp"

namespace mapweld::store {
namespace {

using test::CrashDisk;
using test::SmallCity;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

CrashDisk::Files SmallCityFiles() {
  CrashDisk disk;
  {
    CityStore city("city.db", Database::Mode::kCreate, disk.vfs());
    for (const auto& step : SmallCity::Steps()) step(&city);
  }
  return disk.files();
}

TEST(Fsck, FindsNothingInASoundStore) {
  CrashDisk disk(SmallCityFiles());
  CityStore city("city.db", Database::Mode::kExisting, disk.vfs());
  const FsckReport report = Fsck(&city);
  EXPECT_TRUE(report.Clean()) << ToText(report, "city.db");
  EXPECT_EQ(report.drives, SmallCity::kDrives);
  EXPECT_EQ(report.keyframes, SmallCity::kDrives * SmallCity::kKeyframes);
  EXPECT_EQ(report.merges, 2);
}

// The body of one record changed in the file itself, as a disk does it.
TEST(Fsck, NamesTheDamagedRecordAndOnlyThatIsLeftOut) {
  CrashDisk::Files files = SmallCityFiles();
  std::vector<std::uint8_t>& bytes = files["city.db"];
  const Bytes body = Encode(test::SmallKeyframe(1, 2));
  const auto at = std::search(bytes.begin(), bytes.end(), body.begin(), body.end());
  ASSERT_NE(at, bytes.end());
  at[40] ^= 4;
  CrashDisk disk(std::move(files));
  CityStore city("city.db", Database::Mode::kExisting, disk.vfs());
  EXPECT_THAT(Fsck(&city).damaged, ElementsAre("keyframe 2 of agent_2"));
  EXPECT_THAT(ToJson(Fsck(&city)), HasSubstr("\"clean\": false"));
  const auto drives = city.Drives();
  EXPECT_EQ(city.Keyframes(drives[1].key).size(), SmallCity::kKeyframes - 1U);
  EXPECT_EQ(city.Keyframes(drives[0].key).size(), 0U + SmallCity::kKeyframes);
  EXPECT_EQ(city.MergeDrive(drives[1]).keyframes.size(), 2U) << "the merge takes no drive with a gap";
  EXPECT_THAT(city.damage(), ElementsAre("keyframe 2 of agent_2"));
}

TEST(Fsck, SaysWhatNamesSomethingThatIsNotThere) {
  CrashDisk disk(SmallCityFiles());
  CityStore city("city.db", Database::Mode::kExisting, disk.vfs());
  city.database().Remove(Table::kKeyframes, PairKey(1, 3));
  EXPECT_THAT(Fsck(&city).dangling, ElementsAre("merge 1: keyframes that it placed are not there",
                                                "merge 2: keyframes that it placed are not there"));
  city.database().Remove(Table::kDrives, 2);
  EXPECT_THAT(Fsck(&city).damaged, IsEmpty());
  EXPECT_THAT(Fsck(&city).dangling, testing::Contains("ruling 1: one of its drives is not there"));
}

// A byte of the file changes: opening or fsck says so, or every record is still what it was (the byte meant nothing).
// Here every 37th byte; all of them with MAPWELD_STORE_THOROUGH.
TEST(BitRot, InAnyByteIsFoundOrHarmless) {
  const CrashDisk::Files sound = SmallCityFiles();
  Bytes digest;
  {
    CrashDisk disk(sound);
    CityStore city("city.db", Database::Mode::kExisting, disk.vfs());
    digest = SmallCity::Digest(&city);
  }
  const std::size_t size = sound.at("city.db").size();
  const std::size_t step = std::getenv("MAPWELD_STORE_THOROUGH") != nullptr ? 1 : 37;
  int found = 0;
  int harmless = 0;
  for (std::size_t at = 0; at < size; at += step) {
    CrashDisk::Files files = sound;
    files["city.db"][at] ^= static_cast<std::uint8_t>(1U << (at % 8));
    CrashDisk disk(std::move(files));
    try {
      CityStore city("city.db", Database::Mode::kExisting, disk.vfs());
      if (!Fsck(&city).Clean()) {
        ++found;
        continue;
      }
      ASSERT_TRUE(SmallCity::Digest(&city) == digest) << "byte " << at << " changed a record and nobody noticed";
      ++harmless;
    } catch (const StoreError&) {
      ++found;
    }
  }
  std::printf("%zu bytes: %d changes found, %d without effect\n", size, found, harmless);
  EXPECT_GT(found, harmless / 2);
}

}  // namespace
}  // namespace mapweld::store
