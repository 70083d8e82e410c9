// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "firmware-like/byte_budget.hpp"
#include "firmware-like/rate_group.hpp"

namespace mapweld::executive {
namespace {

TEST(ByteBudget, GrantsTheBurstAndThenTheRate) {
  ByteBudget budget(1000, 500);
  TimeNs now{0};
  EXPECT_TRUE(budget.TrySpend(500, now));
  EXPECT_FALSE(budget.TrySpend(1, now));
  now = now + Milliseconds(100);
  EXPECT_TRUE(budget.TrySpend(100, now));
  EXPECT_FALSE(budget.TrySpend(1, now));
}

TEST(ByteBudget, ALongPauseDoesNotSaveUpMoreThanTheBurst) {
  ByteBudget budget(1000, 500);
  EXPECT_TRUE(budget.TrySpend(500, {0}));
  EXPECT_FALSE(budget.TrySpend(501, {3'600'000'000'000}));
  EXPECT_TRUE(budget.TrySpend(500, {3'600'000'000'000}));
}

TEST(RateGroup, IsDueOncePerPeriodAndDoesNotPileUp) {
  RateGroup group(Milliseconds(50));
  EXPECT_TRUE(group.Due({0}));
  EXPECT_FALSE(group.Due({49'000'000}));
  EXPECT_TRUE(group.Due({50'000'000}));
  EXPECT_TRUE(group.Due({500'000'000}));
  EXPECT_FALSE(group.Due({510'000'000}));
}

TEST(RateGroup, AClockThatWentBackMakesItDue) {
  RateGroup group(Milliseconds(50));
  EXPECT_TRUE(group.Due({1'000'000'000}));
  EXPECT_TRUE(group.Due({0}));
}

}  // namespace
}  // namespace mapweld::executive
