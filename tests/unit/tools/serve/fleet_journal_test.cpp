// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/fleet_journal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "core/submap/submap_codec.hpp"
#include "tests/support/crash_disk.hpp"
#include "tests/support/sort_points.hpp"

namespace mapweld::serve {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

mapweldlcm::keyframe_t Keyframe(int index, double y = 0, int agent = 1) {
  mapweldlcm::keyframe_t m{};
  m.agent_id = static_cast<std::int16_t>(agent);
  m.epoch = 1;
  m.index = index;
  m.odom_t_body[0] = 5.0 * index;
  m.odom_t_body[1] = y;
  m.odom_q_body[3] = 1;
  return m;
}

mapweldlcm::health_t Health(int keyframes, int mode) {
  mapweldlcm::health_t m{};
  m.agent_id = 1;
  m.epoch = 1;
  m.keyframes = keyframes;
  m.mode = static_cast<std::int8_t>(mode);
  return m;
}

mapweldlcm::submap_chunk_t SubmapInOnePiece(int keyframe) {
  const auto submap = std::make_unique<submap::Submap>();
  for (int i = 0; i < 50; ++i) {
    (void)submap->points.TryPush({0.5F * static_cast<float>(i) + 0.2F, 0.2F, 0.2F, 1, 0});
  }
  test::SortPoints(submap.get());
  std::vector<std::uint8_t> bytes(4096);
  bytes.resize(std::make_unique<submap::SubmapEncoder>()->Encode(*submap, bytes).value());
  mapweldlcm::submap_chunk_t m{};
  m.agent_id = 1;
  m.epoch = 1;
  m.keyframe = keyframe;
  m.total_bytes = static_cast<std::int32_t>(bytes.size());
  m.n = static_cast<std::int16_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), m.data);
  return m;
}

// One run of the host on a disk.
class Host {
 public:
  explicit Host(test::CrashDisk* disk) : city_("city.db", store::Database::Mode::kCreate, disk->vfs()) {}
  template <class Message>
  void Take(const Message& message) {
    journal_.Take(message);
  }
  bool Commit(FleetJournal::Clock::time_point now = {}) { return journal_.Commit(now, &mutex_); }

  store::CityStore& city() { return city_; }
  FleetStore& fleet() { return fleet_; }
  FleetJournal& journal() { return journal_; }

 private:
  store::CityStore city_;
  FleetStore fleet_;
  std::mutex mutex_;
  FleetJournal journal_{&city_, &fleet_};
};

TEST(FleetJournal, NothingIsKnownBeforeItIsOnTheDisk) {
  test::CrashDisk disk;
  Host host(&disk);
  const std::size_t before = disk.operations();
  host.Take(Keyframe(0));
  EXPECT_FALSE(host.fleet().HasKeyframe({1, 1}, 0));
  EXPECT_TRUE(host.Commit());
  EXPECT_TRUE(host.fleet().HasKeyframe({1, 1}, 0));
  EXPECT_GT(disk.operations(), before);
}

TEST(FleetJournal, ARestartForgetsNothing) {
  test::CrashDisk disk;
  {
    Host host(&disk);
    for (int k = 0; k < 5; ++k) host.Take(Keyframe(k));
    host.Take(SubmapInOnePiece(2));
    host.Take(Health(7, 2));
    host.Commit();
  }
  Host host(&disk);
  ASSERT_EQ(host.fleet().Drives().drives.size(), 1U);
  EXPECT_EQ(host.fleet().Drives().drives[0].name, "agent_1");
  EXPECT_EQ(host.fleet().Drives().drives[0].keyframes.size(), 5U);
  ASSERT_NE(host.fleet().FindSubmap({1, 1}, 2), nullptr);
  EXPECT_EQ(host.fleet().FindSubmap({1, 1}, 2)->points.size(), 50U);
  EXPECT_THAT(host.fleet().MissingKeyframes({1, 1}, 9), testing::ElementsAre(5, 6));
  host.Take(Keyframe(5));
  host.Take(Keyframe(6));
  host.Take(Health(7, 4));
  host.Commit();
  EXPECT_TRUE(host.fleet().IsComplete({1, 1}));
}

TEST(FleetJournal, WhatIsKnownCostsTheDiskNothing) {
  test::CrashDisk disk;
  Host host(&disk);
  host.Take(Keyframe(0));
  host.Take(Health(1, 2));
  host.Commit();
  const std::size_t before = disk.operations();
  for (int i = 0; i < 100; ++i) {
    host.Take(Keyframe(0));
    host.Take(Health(1, 2));
    EXPECT_FALSE(host.Commit()) << "nothing is new";
  }
  EXPECT_EQ(disk.operations(), before);
}

TEST(FleetJournal, MappingGoesOnWhileTheDiskFailsAndIsSavedWhenItWorksAgain) {
  test::CrashDisk disk;
  const FleetJournal::Clock::time_point start{1000s};
  Host host(&disk);
  host.Take(Keyframe(0));
  host.Commit(start);
  disk.FailAt(0, SQLITE_FULL, true);
  for (int k = 1; k < 4; ++k) {
    host.Take(Keyframe(k));
    EXPECT_TRUE(host.Commit(start + k * 1s));
  }
  EXPECT_EQ(host.fleet().Drives().drives[0].keyframes.size(), 4U) << "in memory";
  EXPECT_EQ(host.journal().unsaved(), 3U);
  EXPECT_THAT(host.journal().trouble(), HasSubstr("the disk is full"));
  EXPECT_EQ(host.city().Keyframes(1).size(), 1U) << "what was there is intact";
  disk.StopFailing();
  host.Commit(start + 20s);
  EXPECT_EQ(host.journal().unsaved(), 0U);
  EXPECT_EQ(host.journal().trouble(), "");
  EXPECT_EQ(host.city().Keyframes(1).size(), 4U);
}

TEST(FleetJournal, AnIntruderWithATakenIdNeitherOverwritesNorIsForgotten) {
  test::CrashDisk disk;
  {
    Host host(&disk);
    host.Take(Keyframe(0));
    host.Take(Keyframe(1));
    host.Commit();
    host.Take(Keyframe(0, 3.0));
    host.Take(Keyframe(2, 3.0));
    host.Commit();
    EXPECT_TRUE(host.fleet().IsDisputed({1, 1}));
    host.Commit();
  }
  Host host(&disk);
  EXPECT_TRUE(host.fleet().IsDisputed({1, 1}));
  EXPECT_TRUE(host.fleet().Drives().drives.empty());
  EXPECT_EQ(host.city().Keyframes(1).size(), 2U) << "nothing of the intruder is on the disk";
  EXPECT_EQ(host.city().Keyframes(1).at(0).odom_T_body.t.y(), 0);
}

}  // namespace
}  // namespace mapweld::serve
