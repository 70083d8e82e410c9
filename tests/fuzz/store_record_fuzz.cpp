// SPDX-License-Identifier: Apache-2.0
// The input is the body of a record of a store, after a byte that says of which table. What a decoder accepts is
// written again as the same bytes; a submap that an agent encoded may have other bytes for the same points.
#include <algorithm>
#include <span>

#include "tests/fuzz/fuzz.hpp"
#include "tools/store/record_codec.hpp"

namespace mapweld::fuzz {
namespace {

template <class T>
void Try(std::span<const std::uint8_t> body) {
  T value;
  if (!store::Decode(body, &value)) return;
  const store::Bytes again = store::Encode(value);
  FUZZ_REQUIRE(again.size() == body.size() && std::equal(again.begin(), again.end(), body.begin()));
}

Bytes WithTable(store::Table table, const store::Bytes& body) {
  Bytes bytes(1 + body.size());
  bytes[0] = static_cast<std::uint8_t>(table);
  std::copy(body.begin(), body.end(), bytes.begin() + 1);
  return bytes;
}

}  // namespace

std::vector<Bytes> Seeds() {
  store::MergeRecord merge;
  merge.cause = "merge";
  merge.drives = {"a", "b"};
  merge.keyframes = {1, 1};
  merge.groups = {{0, 1}};
  merge.merged_T_body = {{{}}, {{}}};
  merge.overlaps.resize(1);
  merge.overlaps[0].drive_b = 1;
  merge.overlaps[0].matches = {{0, 0}};
  merge.overlaps[0].loops.resize(1);
  store::PairRecord pair;
  pair.overlap = merge.overlaps[0];
  pair.asked = {{{0, 1}, true}};
  merge::SubmapCloud cloud;
  cloud.points = {{1, 2, 3}, {4, 5, 6}};
  return {WithTable(store::Table::kDrives, store::Encode(store::DriveInfo{"agent_1", 1, 1, 5, true, false, 7})),
          WithTable(store::Table::kKeyframes, store::Encode(merge::Keyframe{})),
          WithTable(store::Table::kSubmaps, store::Encode(cloud)),
          WithTable(store::Table::kTrajectories, store::Encode(store::ScanTrajectory{{{1}}, {{}}, {0.5}})),
          WithTable(store::Table::kPairs, store::Encode(pair)),
          WithTable(store::Table::kMerges, store::Encode(merge)),
          WithTable(store::Table::kRulings,
                    store::Encode(store::Ruling{store::Ruling::Kind::kQuarantine, "a", "", "now"}))};
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld;
  if (size == 0) return 0;
  const std::span body(data + 1, size - 1);
  switch (static_cast<store::Table>(data[0])) {
    case store::Table::kDrives:
      fuzz::Try<store::DriveInfo>(body);
      break;
    case store::Table::kKeyframes:
      fuzz::Try<merge::Keyframe>(body);
      break;
    case store::Table::kSubmaps: {
      merge::SubmapCloud cloud;
      (void)store::Decode(body, &cloud);
      break;
    }
    case store::Table::kTrajectories:
      fuzz::Try<store::ScanTrajectory>(body);
      break;
    case store::Table::kPairs:
      fuzz::Try<store::PairRecord>(body);
      break;
    case store::Table::kMerges:
      fuzz::Try<store::MergeRecord>(body);
      break;
    case store::Table::kRulings:
      fuzz::Try<store::Ruling>(body);
      break;
  }
  return 0;
}
