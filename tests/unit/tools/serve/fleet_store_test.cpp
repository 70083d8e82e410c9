// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/fleet_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include "core/submap/submap_codec.hpp"
#include "tests/support/sort_points.hpp"

namespace mapweld::serve {
namespace {

using testing::ElementsAre;

mapweldlcm::keyframe_t Keyframe(int agent, int epoch, int index) {
  mapweldlcm::keyframe_t m{};
  m.agent_id = static_cast<std::int16_t>(agent);
  m.epoch = epoch;
  m.index = index;
  m.odom_t_body[0] = 5.0 * index;
  m.odom_q_body[3] = 1;
  m.path_m = 5.0F * static_cast<float>(index);
  return m;
}

mapweldlcm::health_t Health(int agent, int keyframes, int mode) {
  mapweldlcm::health_t m{};
  m.agent_id = static_cast<std::int16_t>(agent);
  m.epoch = 1;
  m.keyframes = keyframes;
  m.mode = static_cast<std::int8_t>(mode);
  return m;
}

constexpr int kPoints = 4000;

std::vector<mapweldlcm::submap_chunk_t> Chunks(int keyframe) {
  const auto submap = std::make_unique<submap::Submap>();
  std::mt19937 random(7);
  const auto inside = [&](int cell) {  // anywhere in it, so that there is something to encode
    return 0.5F * (static_cast<float>(cell) + 0.1F + 0.8F * static_cast<float>(random() % 100) / 100.0F);
  };
  for (int i = 0; i < kPoints; ++i) {
    (void)submap->points.TryPush({inside(i % 100), inside(0), inside(i / 100), 1, 0});
  }
  test::SortPoints(submap.get());
  std::vector<std::uint8_t> bytes(kCap.submap_encoded_bytes);
  bytes.resize(std::make_unique<submap::SubmapEncoder>()->Encode(*submap, bytes).value());
  std::vector<mapweldlcm::submap_chunk_t> chunks;
  for (std::size_t at = 0; at < bytes.size(); at += 1280) {
    mapweldlcm::submap_chunk_t m{};
    m.agent_id = 1;
    m.epoch = 1;
    m.keyframe = keyframe;
    m.total_bytes = static_cast<std::int32_t>(bytes.size());
    m.offset = static_cast<std::int32_t>(at);
    m.n = static_cast<std::int16_t>(std::min<std::size_t>(1280, bytes.size() - at));
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), m.n, m.data);
    chunks.push_back(m);
  }
  return chunks;
}

TEST(FleetStore, GivesOnlyKeyframesWithoutAGapAndSaysWhichAreMissing) {
  FleetStore store;
  for (const int i : {0, 1, 3, 5}) store.Add(Keyframe(1, 1, i));
  EXPECT_EQ(store.Drives().drives.at(0).keyframes.size(), 2U);
  EXPECT_THAT(store.MissingKeyframes({1, 1}, 10), ElementsAre(2, 4));
  store.Add(Health(1, 8, 2));
  EXPECT_THAT(store.MissingKeyframes({1, 1}, 10), ElementsAre(2, 4, 6, 7));
  EXPECT_THAT(store.MissingKeyframes({1, 1}, 2), ElementsAre(2, 4));
}

TEST(FleetStore, IsCompleteOnlyWhenTheDriveHasEndedAndEverythingIsHere) {
  FleetStore store;
  store.Add(Keyframe(1, 1, 0));
  store.Add(Health(1, 2, 4));
  EXPECT_FALSE(store.IsComplete({1, 1}));
  store.Add(Keyframe(1, 1, 1));
  EXPECT_TRUE(store.IsComplete({1, 1}));
  store.Add(Health(1, 1, 2));
  EXPECT_TRUE(store.IsComplete({1, 1})) << "an older message that was overtaken on the way reopens nothing";
}

TEST(FleetStore, FindsTwoVehiclesWithOneIdAndMergesNeither) {
  FleetStore store;
  for (int k = 0; k < 5; ++k) store.Add(Keyframe(1, 1, k));
  mapweldlcm::keyframe_t other = Keyframe(1, 1, 2);
  other.odom_t_body[1] = 3;
  store.Add(other);
  EXPECT_TRUE(store.IsDisputed({1, 1}));
  EXPECT_TRUE(store.Drives().drives.empty()) << "nobody can say whose keyframes these are";
  store.Add(Keyframe(1, 1, 5));
  EXPECT_EQ(store.counters().keyframes, 5U);
  EXPECT_EQ(store.counters().disputed_keyframes, 2U);
  EXPECT_TRUE(store.MissingKeyframes({1, 1}, 10).empty()) << "nothing more is asked for";
}

TEST(FleetStore, ACompleteDriveStaysWhenAnotherVehicleTakesItsName) {
  FleetStore store;
  for (int k = 0; k < 5; ++k) store.Add(Keyframe(1, 1, k));
  store.Add(Health(1, 5, 4));
  mapweldlcm::keyframe_t other = Keyframe(1, 1, 0);
  other.odom_t_body[1] = 3;
  store.Add(other);
  ASSERT_EQ(store.Drives().drives.size(), 1U);
  EXPECT_EQ(store.Drives().drives[0].keyframes[0].odom_T_body.t.y(), 0);
  EXPECT_TRUE(store.IsDisputed({1, 1}));
}

TEST(FleetStore, ARestartedAgentBeginsANewDrive) {
  FleetStore store;
  store.Add(Keyframe(7, 1, 0));
  store.Add(Keyframe(7, 2, 0));
  const auto fleet = store.Drives();
  ASSERT_EQ(fleet.drives.size(), 2U);
  EXPECT_EQ(fleet.drives[0].name, "agent_7");
  EXPECT_EQ(fleet.drives[1].name, "agent_7_boot_2");
}

TEST(FleetStore, TheOrderAndRepetitionOfMessagesDoNotMatter) {
  std::vector<mapweldlcm::keyframe_t> messages;
  for (int i = 0; i < 20; ++i) {
    for (const int agent : {3, 1}) messages.push_back(Keyframe(agent, 1, i));
  }
  messages.insert(messages.end(), messages.begin(), messages.begin() + 15);
  std::mt19937 rng(1);
  for (int trial = 0; trial < 20; ++trial) {
    std::shuffle(messages.begin(), messages.end(), rng);
    FleetStore store;
    for (const auto& m : messages) store.Add(m);
    const auto fleet = store.Drives();
    ASSERT_EQ(fleet.drives.size(), 2U);
    EXPECT_EQ(fleet.drives[0].name, "agent_1");
    EXPECT_EQ(fleet.drives[1].keyframes.size(), 20U);
    EXPECT_EQ(store.counters().repeated_keyframes, 15U);
  }
}

TEST(FleetStore, PutsASubmapTogetherFromPiecesInAnyOrder) {
  auto chunks = Chunks(4);
  ASSERT_GT(chunks.size(), 3U);
  std::mt19937 rng(1);
  std::shuffle(chunks.begin(), chunks.end(), rng);
  FleetStore store;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    EXPECT_EQ(store.FindSubmap({1, 1}, 4), nullptr);
    store.Add(chunks[i]);
    store.Add(chunks[0]);  // repeated
  }
  ASSERT_NE(store.FindSubmap({1, 1}, 4), nullptr);
  EXPECT_EQ(store.FindSubmap({1, 1}, 4)->points.size(), static_cast<std::size_t>(kPoints));
}

TEST(FleetStore, ABrokenSubmapIsCountedAndCanBeSentAgain) {
  auto chunks = Chunks(4);
  chunks[1].data[7] ^= 1;
  FleetStore store;
  for (const auto& chunk : chunks) store.Add(chunk);
  EXPECT_EQ(store.counters().broken_submaps, 1U);
  EXPECT_EQ(store.FindSubmap({1, 1}, 4), nullptr);
  for (const auto& chunk : Chunks(4)) store.Add(chunk);
  EXPECT_NE(store.FindSubmap({1, 1}, 4), nullptr);
}

}  // namespace
}  // namespace mapweld::serve
