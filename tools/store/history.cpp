// SPDX-License-Identifier: Apache-2.0
#include "tools/store/history.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <set>

namespace mapweld::store {
namespace {

using Names = std::set<std::string>;

std::vector<Names> GroupsOf(const MergeRecord& record) {
  std::vector<Names> groups;
  for (const auto& group : record.groups) {
    Names names;
    for (const std::int32_t drive : group) names.insert(record.drives[static_cast<std::size_t>(drive)]);
    groups.push_back(std::move(names));
  }
  return groups;
}

std::set<std::pair<std::string, std::string>> Accepted(const MergeRecord& record) {
  std::set<std::pair<std::string, std::string>> pairs;
  for (const merge::Overlap& overlap : record.overlaps) {
    if (!overlap.accepted) continue;
    pairs.emplace(record.drives[static_cast<std::size_t>(overlap.drive_a)],
                  record.drives[static_cast<std::size_t>(overlap.drive_b)]);
  }
  return pairs;
}

bool Same(const Ruling& x, const Ruling& y) {
  return x.kind == y.kind && x.drive_a == y.drive_a && x.drive_b == y.drive_b;
}

std::int64_t NextKey(CityStore* store, Table table) {
  const std::vector<std::int64_t> keys = store->database().Keys(table);
  return keys.empty() ? 1 : keys.back() + 1;
}

std::string Joined(const Names& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " + ") + name;
  return text;
}

// The part of a group's drives that another state has.
Names Common(const Names& x, const Names& y) {
  Names common;
  std::set_intersection(x.begin(), x.end(), y.begin(), y.end(), std::inserter(common, common.end()));
  return common;
}

// Groups and poses as before; a drive that is new stands alone, in its own odometry.
void RestoreGroups(CityStore* store, const MergeRecord& before, MergeRecord* after) {
  std::map<std::string, std::int32_t> index;
  for (std::size_t d = 0; d < after->drives.size(); ++d) index[after->drives[d]] = static_cast<std::int32_t>(d);
  after->groups.clear();
  std::set<std::int32_t> placed;
  for (const Names& names : GroupsOf(before)) {
    std::vector<std::int32_t> group;
    for (const std::string& name : names) {
      if (index.contains(name)) group.push_back(index[name]);
    }
    placed.insert(group.begin(), group.end());
    if (!group.empty()) after->groups.push_back(group);
  }
  for (std::size_t d = 0; d < before.drives.size(); ++d) {
    const auto at = index.find(before.drives[d]);
    if (at != index.end()) after->merged_T_body[static_cast<std::size_t>(at->second)] = before.merged_T_body[d];
  }
  for (const auto& [name, drive] : index) {
    if (placed.contains(drive)) continue;
    after->groups.push_back({drive});
    std::vector<geom::Pose3>& poses = after->merged_T_body[static_cast<std::size_t>(drive)];
    const auto stored = store->FindDrive(name);
    if (!stored.has_value()) continue;
    const merge::Drive odometry = store->MergeDrive(*stored);
    for (std::size_t k = 0; k < std::min(poses.size(), odometry.keyframes.size()); ++k) {
      poses[k] = odometry.keyframes[k].odom_T_body;
    }
  }
}

}  // namespace

std::vector<NumberedMerge> Merges(CityStore* store) {
  std::vector<NumberedMerge> merges;
  store->database().ForEach(Table::kMerges, 0, INT64_MAX, [&](const Record& record) {
    auto merge = store->Decoded<MergeRecord>(Table::kMerges, record);
    if (merge.has_value()) merges.push_back({record.key, std::move(*merge)});
  });
  return merges;
}

std::optional<NumberedMerge> LastMerge(CityStore* store) {
  const std::vector<std::int64_t> keys = store->database().Keys(Table::kMerges);
  for (auto key = keys.rbegin(); key != keys.rend(); ++key) {
    auto merge = store->Read<MergeRecord>(Table::kMerges, *key);
    if (merge.has_value()) return NumberedMerge{*key, std::move(*merge)};
  }
  return std::nullopt;
}

MergeRecord ToRecord(const std::vector<merge::Drive>& drives, const merge::MergeResult& result, std::string cause,
                     std::string when) {
  MergeRecord record;
  record.when = std::move(when);
  record.cause = std::move(cause);
  for (const merge::Drive& drive : drives) {
    record.drives.push_back(drive.name);
    record.keyframes.push_back(static_cast<std::int32_t>(drive.keyframes.size()));
  }
  for (const std::vector<int>& group : result.groups) record.groups.emplace_back(group.begin(), group.end());
  record.overlaps = result.overlaps;
  record.merged_T_body = result.merged_T_body;
  return record;
}

std::int64_t RecordMerge(CityStore* store, const MergeRecord& record) {
  std::int64_t number = 0;
  store->Write([&] {
    const auto last = LastMerge(store);
    if (last.has_value()) {
      MergeRecord same = last->record;
      same.when = record.when;
      same.cause = record.cause;
      number = last->number;
      if (Encode(same) == Encode(record)) return;
    }
    number = NextKey(store, Table::kMerges);
    store->database().Put(Table::kMerges, number, Encode(record));
  });
  return number;
}

StoredDrive DriveCalled(CityStore* store, const std::string& name) {
  std::string known;
  for (StoredDrive& drive : store->Drives()) {
    if (drive.info.name == name) return std::move(drive);
    known += (known.empty() ? "" : ", ") + drive.info.name;
  }
  throw StoreError(fmt::format("the store {} holds no drive called '{}'; it holds {}",
                               store->database().path().string(), name, known.empty() ? "none" : known));
}

std::vector<NumberedRuling> Rulings(CityStore* store) {
  std::vector<NumberedRuling> rulings;
  store->database().ForEach(Table::kRulings, 0, INT64_MAX, [&](const Record& record) {
    auto ruling = store->Decoded<Ruling>(Table::kRulings, record);
    if (ruling.has_value()) rulings.push_back({record.key, std::move(*ruling)});
  });
  return rulings;
}

void AddRuling(CityStore* store, const Ruling& ruling) {
  store->Write([&] {
    (void)DriveCalled(store, ruling.drive_a);
    if (ruling.kind == Ruling::Kind::kRefusePair) (void)DriveCalled(store, ruling.drive_b);
    for (const NumberedRuling& known : Rulings(store)) {
      if (Same(known.ruling, ruling)) return;
    }
    store->database().Put(Table::kRulings, NextKey(store, Table::kRulings), Encode(ruling));
  });
}

bool RemoveRuling(CityStore* store, const Ruling& ruling) {
  bool removed = false;
  store->Write([&] {
    for (const NumberedRuling& known : Rulings(store)) {
      if (!Same(known.ruling, ruling)) continue;
      store->database().Remove(Table::kRulings, known.number);
      removed = true;
    }
  });
  return removed;
}

std::vector<std::pair<std::string, std::string>> Undo(CityStore* store, const std::string& when) {
  std::vector<std::pair<std::string, std::string>> withdrawn;
  store->Write([&] {
    const std::vector<NumberedMerge> merges = Merges(store);
    if (merges.empty()) {
      throw StoreError(fmt::format("the store {} holds no merge to undo", store->database().path().string()));
    }
    const NumberedMerge& last = merges.back();
    const MergeRecord before = merges.size() > 1 ? merges[merges.size() - 2].record : MergeRecord{};
    const auto known = Accepted(before);
    for (const auto& pair : Accepted(last.record)) {
      if (known.contains(pair)) continue;
      withdrawn.push_back(pair);
      AddRuling(store, {Ruling::Kind::kRefusePair, std::min(pair.first, pair.second), std::max(pair.first, pair.second),
                        when});
    }
    if (withdrawn.empty()) {
      throw StoreError(fmt::format("merge {} joined nothing that was not joined before; nothing to undo", last.number));
    }
    MergeRecord after = last.record;
    after.when = when;
    after.cause = fmt::format("undo of {}", last.number);
    after.is_final = true;
    for (merge::Overlap& overlap : after.overlaps) {
      const std::pair<std::string, std::string> pair(after.drives[static_cast<std::size_t>(overlap.drive_a)],
                                                     after.drives[static_cast<std::size_t>(overlap.drive_b)]);
      if (!overlap.accepted || known.contains(pair)) continue;
      overlap.accepted = false;
      overlap.weight = 0;
      overlap.test = kByHand;
    }
    RestoreGroups(store, before, &after);
    store->database().Put(Table::kMerges, last.number + 1, Encode(after));
  });
  return withdrawn;
}

std::vector<std::string> Changes(const MergeRecord* before, const MergeRecord& after) {
  std::vector<std::string> changes;
  const std::vector<Names> old_groups = before == nullptr ? std::vector<Names>{} : GroupsOf(*before);
  const std::vector<Names> new_groups = GroupsOf(after);
  Names old_drives;
  for (const Names& group : old_groups) old_drives.insert(group.begin(), group.end());
  const Names drives(after.drives.begin(), after.drives.end());
  for (const std::string& name : drives) {
    if (!old_drives.contains(name)) changes.push_back(fmt::format("{} came", name));
  }
  for (const std::string& name : old_drives) {
    if (!drives.contains(name)) changes.push_back(fmt::format("{} was set aside", name));
  }
  // A group of several drives that no old group contains has been joined; one that is now in several has split.
  for (const Names& group : new_groups) {
    if (group.size() < 2) continue;
    const bool was_one = std::any_of(old_groups.begin(), old_groups.end(),
                                     [&](const Names& old) { return Common(old, group).size() == group.size(); });
    if (!was_one) changes.push_back(fmt::format("{} joined", Joined(group)));
  }
  for (const Names& old : old_groups) {
    Names left = Common(old, drives);
    const bool is_one = std::any_of(new_groups.begin(), new_groups.end(),
                                    [&](const Names& group) { return Common(left, group).size() == left.size(); });
    if (left.size() > 1 && !is_one) changes.push_back(fmt::format("{} split", Joined(left)));
  }
  return changes;
}

std::string TimeLabel() {
  return fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(std::time(nullptr)));
}

}  // namespace mapweld::store
