// SPDX-License-Identifier: Apache-2.0
#include "tools/ranks/result_codec.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace mapweld::ranks {
namespace {

using ::testing::ElementsAre;

geom::Pose3 SomePose(double x) {
  return {{x, 0.1, -1e-17}, geom::ExpSo3({0.3, -0.2, x})};
}

merge::PairOutcome SomeOutcome() {
  merge::PairOutcome out;
  out.proposed = true;
  out.evidence = 0.1 + 0.2;
  out.overlap.drive_a = 3;
  out.overlap.drive_b = 8;
  out.overlap.accepted = true;
  out.overlap.test = "registration";
  out.overlap.a_T_b = SomePose(7);
  out.overlap.matches = {{1, 2}, {3, 4}};
  out.overlap.loops = {{5, 6, SomePose(1), 0.7, 0.25, 1}};
  out.asked = {{{3, 5}, true}, {{8, 6}, false}};
  return out;
}

// What is read is written again to the same bytes, so nothing was lost on the way.
template <class Result>
Result GoesThrough(const Result& result) {
  const store::Bytes bytes = Encode(result);
  Result out;
  Decode(bytes, &out);
  EXPECT_EQ(Encode(out), bytes);
  return out;
}

TEST(ResultCodec, KeepsAnOutcomeToTheLastBit) {
  const merge::PairOutcome in = SomeOutcome();
  const merge::PairOutcome out = GoesThrough(in);
  EXPECT_EQ(out.overlap.test, "registration");
  EXPECT_EQ(out.overlap.a_T_b.t, in.overlap.a_T_b.t);
  EXPECT_EQ(out.overlap.a_T_b.q.coeffs(), in.overlap.a_T_b.q.coeffs());
  EXPECT_EQ(out.evidence, in.evidence);
  EXPECT_EQ(out.asked, in.asked);
}

TEST(ResultCodec, KeepsAssociationsOfNoneAndOfMany) {
  EXPECT_TRUE(GoesThrough(std::vector<merge::Association>{}).empty());
  merge::Association one;
  one.matches = {{4, 9, 3.25, true, false, true}};
  one.evidence = {1.5, 2.5};
  one.compared = true;
  const auto out = GoesThrough(std::vector<merge::Association>{{}, one});
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out[1].matches.front().b, 9);
  EXPECT_TRUE(out[1].matches.front().ends);
  EXPECT_EQ(out[1].evidence.single, 2.5);
}

TEST(ResultCodec, KeepsARefinement) {
  merge::PairRefinement in;
  in.loops = {{1, 2, SomePose(3), 0.4, 0.5, 0.6, 0.7}};
  in.contradictions = 5;
  in.asked = {{{0, 1}, true}};
  const merge::PairRefinement out = GoesThrough(in);
  EXPECT_EQ(out.loops.front().torn_share, 0.7);
  EXPECT_EQ(out.contradictions, 5);
}

TEST(ResultCodec, KeepsASolution) {
  merge::GroupSolution in;
  in.merged_T_body = {{SomePose(1), SomePose(2)}, {}};
  in.loop_weight = {1, 0.25};
  const merge::GroupSolution out = GoesThrough(in);
  EXPECT_EQ(out.merged_T_body.size(), 2U);
  EXPECT_THAT(out.loop_weight, ElementsAre(1, 0.25));
}

TEST(ResultCodec, UnpacksWhatItPacked) {
  const std::vector<store::Bytes> results{{1, 2, 3}, {}, {4}};
  EXPECT_EQ(Unpack(Pack(results)), results);
}

TEST(ResultCodec, RefusesBytesCutOffAnywhere) {
  const store::Bytes whole = Encode(SomeOutcome());
  for (std::size_t n = 0; n < whole.size(); ++n) {
    merge::PairOutcome out;
    EXPECT_THROW(Decode(std::span(whole).first(n), &out), std::runtime_error) << n;
  }
}

}  // namespace
}  // namespace mapweld::ranks
