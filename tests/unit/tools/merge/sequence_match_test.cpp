// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/sequence_match.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tools/merge/association.hpp"
#include "tools/merge/cosine_kernel.hpp"

namespace mapweld::merge {
namespace {

std::int16_t Cosine(float distance) {
  return static_cast<std::int16_t>(std::lround((1 - distance) * static_cast<float>(kCosineUnit)));
}

// Noise of mean 0.6 with a line of lower distances: row = first_row + k, col = first_col + slope * k.
Cosines Planted(int rows, int cols, int first_row, int first_col, double slope, int length, float dip) {
  std::mt19937 random(5);
  Cosines out{rows, cols, {}};
  for (int i = 0; i < rows * cols; ++i)
    out.c.push_back(Cosine(0.6F + 0.1F * (static_cast<float>(random() % 2001) / 1000.0F - 1)));
  for (int k = 0; k < length; ++k) {
    const int col = first_col + static_cast<int>(std::lround(slope * k));
    out.c[static_cast<std::size_t>((first_row + k) * cols + col)] +=
        static_cast<std::int16_t>(std::lround(dip * kCosineUnit));
  }
  return out;
}

class SequenceMatch : public ::testing::TestWithParam<double> {};

TEST_P(SequenceMatch, FindsAPlantedLineAndItsDirection) {
  const double slope = GetParam();
  const int first_col = slope > 0 ? 20 : 80;
  // A dip within the noise of +-0.1: no single entry stands out.
  const Cosines distances = Planted(90, 110, 30, first_col, slope, 24, 0.1F);
  const std::vector<Match> matches = MatchSequences(ComputeLikeness(distances), {});
  ASSERT_FALSE(matches.empty());
  const Match& best = matches.front();
  EXPECT_TRUE(best.sequence);
  EXPECT_EQ(best.reverse, slope < 0);
  EXPECT_GE(best.a, 30);
  EXPECT_LT(best.a, 54);
  EXPECT_NEAR(best.b, first_col + slope * (best.a - 30), 3);
}

INSTANTIATE_TEST_SUITE_P(Slopes, SequenceMatch, ::testing::Values(1.0, 0.8, 1.25, -1.0, -0.8, -1.25));

TEST(SequenceMatchBorders, FindAShortLineInACorner) {
  const Cosines distances = Planted(60, 60, 54, 0, 1.0, 6, 0.35F);
  const std::vector<Match> matches = MatchSequences(ComputeLikeness(distances), {});
  ASSERT_FALSE(matches.empty());
  EXPECT_GE(matches.front().a, 54);
  EXPECT_LE(matches.front().b, 6);
}

TEST(SequenceMatchNoise, ProposesLittle) {
  const std::vector<Match> matches = MatchSequences(ComputeLikeness(Planted(80, 80, 0, 0, 1, 0, 0)), {});
  EXPECT_LE(matches.size(), 24U);
  for (const Match& match : matches) EXPECT_LT(match.score, 6.5);
}

TEST(SingleMatch, FindsOneEntryFarBelowItsRowAndColumn) {
  Cosines distances = Planted(50, 40, 0, 0, 1, 0, 0);
  distances.c[17 * 40 + 23] = Cosine(0.1F);
  const std::vector<Match> matches = MatchSingles(ComputeLikeness(distances), {});
  ASSERT_FALSE(matches.empty());
  EXPECT_EQ(matches.front().a, 17);
  EXPECT_EQ(matches.front().b, 23);
}

TEST(SingleMatch, IsNotFooledByAKeyframeThatResemblesEverything) {
  Cosines distances = Planted(50, 40, 0, 0, 1, 0, 0);
  for (std::size_t row = 0; row < 50; ++row) distances.c[row * 40 + 7] += 2458;
  distances.c[17 * 40 + 23] = Cosine(0.25F);
  const std::vector<Match> matches = MatchSingles(ComputeLikeness(distances), {});
  ASSERT_FALSE(matches.empty());
  EXPECT_EQ(matches.front().b, 23);
}

TEST(Candidates, IncludeTheMeetingsOfTheEndsHoweverUnlike) {
  const std::vector<Match> matches = ProposeMatches(ComputeLikeness(Planted(30, 20, 0, 0, 1, 0, 0)), {});
  for (const int a : {0, 29}) {
    for (const int b : {0, 19}) {
      EXPECT_TRUE(
          std::any_of(matches.begin(), matches.end(), [&](const Match& m) { return m.a == a && m.b == b && m.ends; }));
    }
  }
}

TEST(Candidates, OfNothingAreNone) {
  EXPECT_TRUE(ProposeMatches(ComputeLikeness(Cosines{}), {}).empty());
  EXPECT_TRUE(ProposeMatches(ComputeLikeness(Cosines{3, 0, {}}), {}).empty());
}

}  // namespace
}  // namespace mapweld::merge
