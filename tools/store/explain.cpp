// SPDX-License-Identifier: Apache-2.0
#include "tools/store/explain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "tools/merge/difference.hpp"
#include "tools/store/history.hpp"

namespace mapweld::store {
namespace {

constexpr std::size_t kLoopsShown = 20;

std::int32_t IndexIn(const MergeRecord& record, const std::string& name) {
  const auto at = std::find(record.drives.begin(), record.drives.end(), name);
  return at == record.drives.end() ? -1 : static_cast<std::int32_t>(at - record.drives.begin());
}

int GroupOf(const MergeRecord& record, std::int32_t drive) {
  for (std::size_t g = 0; g < record.groups.size(); ++g) {
    if (std::find(record.groups[g].begin(), record.groups[g].end(), drive) != record.groups[g].end()) {
      return static_cast<int>(g) + 1;
    }
  }
  return 0;
}

// The two keyframes that are most alike, from the descriptors alone.
std::string Likeness(const merge::Drive& a, const merge::Drive& b) {
  const merge::Distances distances = merge::ComputeDistances(a, b);
  if (distances.d.empty()) return "";
  const auto best = std::min_element(distances.d.begin(), distances.d.end()) - distances.d.begin();
  return fmt::format(
      "most alike    keyframe {} of {} and {} of {}, descriptor distance {:.3f} (0 the same, 1 nothing in common)\n",
      best / distances.cols, a.name, best % distances.cols, b.name,
      static_cast<double>(distances.d[static_cast<std::size_t>(best)]));
}

std::string Loops(const merge::Overlap& overlap) {
  std::string text =
      fmt::format("loops         {} pairs of keyframes that registration confirmed\n", overlap.loops.size());
  if (overlap.loops.empty()) return text;
  text += "                    a      b    overlap   residual m   weight\n";
  for (std::size_t i = 0; i < std::min(kLoopsShown, overlap.loops.size()); ++i) {
    const merge::Loop& loop = overlap.loops[i];
    text += fmt::format("                {:5}  {:5}      {:.2f}        {:.3f}     {:.2f}\n", loop.keyframe_a,
                        loop.keyframe_b, loop.overlap_ratio, loop.residual_m, loop.weight);
  }
  if (overlap.loops.size() > kLoopsShown)
    text += fmt::format("                and {} more\n", overlap.loops.size() - kLoopsShown);
  return text;
}

}  // namespace

std::string Explain(CityStore* store, const std::string& name_a, const std::string& name_b) {
  StoredDrive first = DriveCalled(store, name_a);
  StoredDrive second = DriveCalled(store, name_b);
  const auto last = LastMerge(store);
  if (!last.has_value()) {
    throw StoreError(fmt::format("the store {} holds no merge yet", store->database().path().string()));
  }
  const MergeRecord& record = last->record;
  // In the order of the merge, whose records speak of a and b.
  const bool swapped = IndexIn(record, name_b) >= 0 && IndexIn(record, name_b) < IndexIn(record, name_a);
  if (swapped) std::swap(first, second);
  const std::int32_t a = IndexIn(record, first.info.name);
  const std::int32_t b = IndexIn(record, second.info.name);
  std::string text = fmt::format("a = {}, b = {}; merge {} of {} UTC ({})\n", first.info.name, second.info.name,
                                 last->number, record.when, record.cause);
  if (a < 0 || b < 0) {
    return text + fmt::format("verdict       {} was not part of it: set aside, or newer than it\n",
                              a < 0 ? first.info.name : second.info.name);
  }
  const merge::Drive drive_a = store->MergeDrive(first);
  const merge::Drive drive_b = store->MergeDrive(second);
  const int group_a = GroupOf(record, a);
  const int group_b = GroupOf(record, b);
  const std::string groups = group_a == group_b ? fmt::format("both in group {}", group_a)
                                                : fmt::format("in groups {} and {}", group_a, group_b);
  const auto overlap = std::find_if(record.overlaps.begin(), record.overlaps.end(),
                                    [&](const merge::Overlap& o) { return o.drive_a == a && o.drive_b == b; });
  if (overlap == record.overlaps.end()) {
    return text + fmt::format(
                      "verdict       no overlap, {}\ntest          association: nothing in the two drives is alike "
                      "enough to be tried\n{}",
                      groups, Likeness(drive_a, drive_b));
  }
  text += fmt::format("verdict       {}, {}\n", overlap->accepted ? "overlap accepted" : "overlap refused", groups);
  text += fmt::format("test          {} (the one that decided)\n", overlap->test);
  text += Likeness(drive_a, drive_b);
  text += fmt::format("matches       {} pairs of keyframes that association proposed\n", overlap->matches.size());
  text += Loops(*overlap);
  if (overlap->accepted) {
    text += fmt::format("shared        {:.0f} m, driven in {}; weight {:.3f} (omega, eq. 9)\n", overlap->length_m,
                        overlap->reverse ? "opposite directions" : "the same direction", overlap->weight);
  }
  const auto pair = store->Read<PairRecord>(Table::kPairs, PairKey(first.key, static_cast<std::int32_t>(second.key)));
  if (pair.has_value()) {
    std::size_t missing = 0;
    for (const auto& [key, found] : pair->asked) missing += found ? 0 : 1;
    text += fmt::format("search        {} submaps looked at, {} of them missing; evidence {:.2f} in sum\n",
                        pair->asked.size() - missing, missing, pair->evidence);
  }
  return text;
}

}  // namespace mapweld::store
