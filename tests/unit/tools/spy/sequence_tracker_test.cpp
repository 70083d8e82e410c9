// SPDX-License-Identifier: Apache-2.0
#include "tools/spy/sequence_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace mapweld::spy {
namespace {

TEST(SequenceTracker, MissesNothingInAnUnbrokenRun) {
  for (const std::uint32_t begin : {0U, 5U, 0xFFFFFFF0U}) {
    SequenceTracker tracker;
    for (std::uint32_t i = 0; i < 5000; ++i) ASSERT_TRUE(tracker.Take(begin + i));
    EXPECT_EQ(tracker.missing(), 0U);
  }
}

TEST(SequenceTracker, CountsExactlyWhatIsLeftOutRepeatedAndReordered) {
  std::mt19937 random(1);
  for (int round = 0; round < 20; ++round) {
    std::vector<std::uint32_t> numbers;
    std::uint64_t left_out = 0;
    std::uint64_t repeated = 0;
    for (std::uint32_t i = 0; i < 3000; ++i) {
      if (i > 0 && i < 2999 && random() % 10 == 0) {
        ++left_out;
        continue;
      }
      numbers.push_back(0xFFFFFC00U + i);
      if (random() % 20 == 0) {
        ++repeated;
        numbers.push_back(0xFFFFFC00U + i);
      }
    }
    // The first and the last stay where they are: what lies outside of them is unknown.
    for (std::size_t i = 1; i + 52 < numbers.size(); i += 50) {
      std::shuffle(numbers.begin() + static_cast<std::ptrdiff_t>(i),
                   numbers.begin() + static_cast<std::ptrdiff_t>(i) + 50, random);
    }
    SequenceTracker tracker;
    std::uint64_t seen_before = 0;
    for (const std::uint32_t number : numbers) seen_before += tracker.Take(number) ? 0U : 1U;
    EXPECT_EQ(tracker.missing(), left_out);
    EXPECT_EQ(seen_before, repeated);
  }
}

TEST(SequenceTracker, TakesNoLossFromWhatWasSentBeforeItListened) {
  SequenceTracker tracker;
  EXPECT_TRUE(tracker.Take(100));
  EXPECT_TRUE(tracker.Take(103));
  EXPECT_EQ(tracker.missing(), 2U);
  EXPECT_TRUE(tracker.Take(99)) << "overtaken by the first one heard";
  EXPECT_EQ(tracker.missing(), 2U);
  EXPECT_TRUE(tracker.Take(101));
  EXPECT_EQ(tracker.missing(), 1U);
}

TEST(SequenceTracker, TakesARestartedSenderForANewOne) {
  SequenceTracker tracker;
  EXPECT_TRUE(tracker.Take(3'000'000'000U));
  EXPECT_TRUE(tracker.Take(0));
  EXPECT_TRUE(tracker.Take(1));
  EXPECT_EQ(tracker.missing(), 0U);
}

}  // namespace
}  // namespace mapweld::spy
