// SPDX-License-Identifier: Apache-2.0
#include "tools/store/record_codec.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/small_city.hpp"

namespace mapweld::store {
namespace {

MergeRecord SomeMerge() {
  MergeRecord record;
  record.when = "2026-01-01 00:00:00";
  record.cause = "merge";
  record.is_final = true;
  record.drives = {"a", "b"};
  record.keyframes = {1, 2};
  record.groups = {{0, 1}};
  record.merged_T_body = {{test::SmallKeyframe(0, 1).odom_T_body}, {{}, {}}};
  record.overlaps.resize(1);
  record.overlaps[0].drive_b = 1;
  record.overlaps[0].test = "cycle";
  record.overlaps[0].matches = {{1, 2}, {3, 4}};
  record.overlaps[0].loops = {{5, 6, test::SmallKeyframe(1, 1).odom_T_body, 0.5, 0.1, 0.9}};
  return record;
}

PairRecord SomePair() {
  PairRecord pair;
  pair.method = 0x1234567890ABCDEF;
  pair.keyframes_a = 3;
  pair.evidence = 1.0 / 3;
  pair.overlap = SomeMerge().overlaps[0];
  pair.asked = {{{0, 7}, true}, {{1, 9}, false}};
  return pair;
}

template <class T>
void ExpectExact(const T& value) {
  const Bytes bytes = Encode(value);
  T back;
  ASSERT_TRUE(Decode(bytes, &back));
  EXPECT_EQ(Encode(back), bytes);
  // Cut short anywhere, and with something behind.
  for (std::size_t n = 0; n < bytes.size(); n += 1 + n / 50) {
    T rest;
    EXPECT_FALSE(Decode(std::span(bytes).first(n), &rest)) << n << " of " << bytes.size();
  }
  Bytes longer = bytes;
  longer.push_back(0);
  T rest;
  EXPECT_FALSE(Decode(longer, &rest));
}

TEST(RecordCodec, ReadsExactlyWhatWasWritten) {
  ExpectExact(DriveInfo{"agent_3", 3, 2, 17, true, false, 99});
  ExpectExact(test::SmallKeyframe(1, 2));
  ExpectExact(SomeMerge());
  ExpectExact(SomePair());
  ExpectExact(ScanTrajectory{{{1}, {2}}, {{}, {}}, {0.0, 1.0 / 3}});
  ExpectExact(Ruling{Ruling::Kind::kRefusePair, "a", "b", "now"});
  merge::SubmapCloud cloud;
  ASSERT_TRUE(Decode(Encode(test::SmallSubmap(1, 2)), &cloud));
  EXPECT_TRUE(cloud.points == test::SmallSubmap(1, 2).points);
}

TEST(RecordCodec, RefusesWhatContradictsItself) {
  MergeRecord record = SomeMerge();
  record.groups = {{0, 2}};
  MergeRecord out;
  EXPECT_FALSE(Decode(Encode(record), &out)) << "a drive that it does not list";
  merge::Keyframe keyframe = test::SmallKeyframe(0, 0);
  keyframe.odom_T_body.q.coeffs().setZero();
  EXPECT_FALSE(Decode(Encode(keyframe), &keyframe)) << "not a pose";
}

}  // namespace
}  // namespace mapweld::store
