// SPDX-License-Identifier: Apache-2.0
// What became of the city, merge by merge, and the decisions of people that later merges keep to.
//
// A merge is a pure function of the drives and of the rulings, so history is never rewritten: to undo a merge means to
// rule that the pairs which it accepted for the first time are refused, and to record the state that follows.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/store/city_store.hpp"

namespace mapweld::store {

struct NumberedMerge {
  std::int64_t number = 0;
  MergeRecord record;
};
struct NumberedRuling {
  std::int64_t number = 0;
  Ruling ruling;
};

// Why a pair that somebody refused is not accepted: the `test` of its overlap.
inline constexpr const char* kByHand = "withdrawn by hand";

// Oldest first.
std::vector<NumberedMerge> Merges(CityStore* store);
std::optional<NumberedMerge> LastMerge(CityStore* store);
// The state as a record; drives by their names.
MergeRecord ToRecord(const std::vector<merge::Drive>& drives, const merge::MergeResult& result, std::string cause,
                     std::string when);
// Adds the record as the newest, unless drives, decisions and poses are those of the newest already. Gives its number.
std::int64_t RecordMerge(CityStore* store, const MergeRecord& record);

// Throws StoreError, with the names that there are.
StoredDrive DriveCalled(CityStore* store, const std::string& name);
std::vector<NumberedRuling> Rulings(CityStore* store);
// Adds it if it is not there. Throws StoreError for a drive that the store does not hold.
void AddRuling(CityStore* store, const Ruling& ruling);
// false: there was none.
bool RemoveRuling(CityStore* store, const Ruling& ruling);

// Withdraws what the newest merge joined, and records what is left: its drives in the groups of the merge before, those
// that came with it alone. Gives the pairs withdrawn. Throws StoreError when there is nothing to undo.
std::vector<std::pair<std::string, std::string>> Undo(CityStore* store, const std::string& when);

// The pairs of groups that two states differ by, one sentence each: "monday + tuesday joined", ...
std::vector<std::string> Changes(const MergeRecord* before, const MergeRecord& after);

// "2026-11-25 22:17:56", UTC, of the host's clock.
std::string TimeLabel();

}  // namespace mapweld::store
