// SPDX-License-Identifier: Apache-2.0
#include "tools/ranks/job_board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace mapweld::ranks {
namespace {

using ::testing::ElementsAre;
using ::testing::Eq;
using ::testing::Optional;

TEST(JobBoard, HandsOutEveryJobOnceInOrder) {
  JobBoard board(3);
  for (int i = 0; i < 3; ++i) EXPECT_THAT(board.Take(), Optional(i));
}

TEST(JobBoard, GivesAJobThatNobodyAnswersToTheNextWhoAsks) {
  JobBoard board(3);
  for (int i = 0; i < 3; ++i) (void)board.Take();
  board.Put(0, {10});
  board.Put(2, {12});
  EXPECT_THAT(board.Take(), Optional(1));
  EXPECT_FALSE(board.AllDone());
  board.Put(1, {11});
  EXPECT_TRUE(board.AllDone());
  EXPECT_THAT(board.Take(), Eq(std::nullopt));
}

TEST(JobBoard, SharesOutstandingJobsEvenly) {
  JobBoard board(2);
  (void)board.Take();
  (void)board.Take();
  EXPECT_THAT(board.Take(), Optional(0));
  EXPECT_THAT(board.Take(), Optional(1));
  EXPECT_THAT(board.Take(), Optional(0));
}

TEST(JobBoard, KeepsTheFirstOfTwoResults) {
  JobBoard board(1);
  (void)board.Take();
  (void)board.Take();
  EXPECT_TRUE(board.Put(0, {1}));
  EXPECT_FALSE(board.Put(0, {2}));
  EXPECT_EQ(board.done(), 1);
  EXPECT_THAT(std::move(board).Results(), ElementsAre(store::Bytes{1}));
}

TEST(JobBoard, RefusesAResultOfNoJob) {
  JobBoard board(1);
  EXPECT_THROW(board.Put(1, {}), std::out_of_range);
  EXPECT_THROW(board.Put(-1, {}), std::out_of_range);
}

TEST(JobBoard, WithoutJobsIsDone) {
  JobBoard board(0);
  EXPECT_TRUE(board.AllDone());
  EXPECT_THAT(board.Take(), Eq(std::nullopt));
}

}  // namespace
}  // namespace mapweld::ranks
