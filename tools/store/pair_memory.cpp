// SPDX-License-Identifier: Apache-2.0
#include "tools/store/pair_memory.hpp"

#include <algorithm>
#include <mutex>
#include <utility>

#include "tools/merge/parallel.hpp"
#include "tools/store/method.hpp"

namespace mapweld::store {
namespace {

// The merge lets nothing bring back an overlap that its own cycle check refused; a refusal by hand has to last as well.
constexpr const char* kLastingTest = "cycle";

std::int32_t Count(const merge::Drive& drive) {
  return static_cast<std::int32_t>(drive.keyframes.size());
}

// Drives a and b of the rulings that refuse a pair, where both are in the list; a < b.
std::vector<std::pair<int, int>> RefusedPairs(const std::vector<NumberedRuling>& rulings,
                                              const std::vector<merge::Drive>& drives) {
  const auto index = [&](const std::string& name) {
    const auto at = std::find_if(drives.begin(), drives.end(), [&](const auto& drive) { return drive.name == name; });
    return at == drives.end() ? -1 : static_cast<int>(at - drives.begin());
  };
  std::vector<std::pair<int, int>> pairs;
  for (const NumberedRuling& ruling : rulings) {
    if (ruling.ruling.kind != Ruling::Kind::kRefusePair) continue;
    const int a = index(ruling.ruling.drive_a);
    const int b = index(ruling.ruling.drive_b);
    if (a >= 0 && b >= 0 && a != b) pairs.emplace_back(std::min(a, b), std::max(a, b));
  }
  return pairs;
}

}  // namespace

PairMemory::PairMemory(CityStore* store, const std::vector<merge::Drive>* drives, std::vector<DriveKey> keys,
                       const merge::MergeConfig* config)
    : store_(store), drives_(drives), keys_(std::move(keys)), config_(config), method_(MethodOf(*config)) {}

std::int64_t PairMemory::KeyOf(int a, int b) const {
  return PairKey(keys_[static_cast<std::size_t>(a)], static_cast<std::int32_t>(keys_[static_cast<std::size_t>(b)]));
}

std::optional<PairRecord> PairMemory::Known(int a, int b, merge::SubmapSource* submaps) {
  if (!AreStored(a, b)) return std::nullopt;
  auto pair = store_->Read<PairRecord>(Table::kPairs, KeyOf(a, b));
  if (!pair.has_value() || pair->method != method_) return std::nullopt;
  if (pair->keyframes_a != Count(DriveAt(a)) || pair->keyframes_b != Count(DriveAt(b))) return std::nullopt;
  // Submaps never go, so only those that were missing need a look.
  for (const auto& [key, found] : pair->asked) {
    if (!found && submaps->Has({key.drive == 0 ? a : b, key.keyframe})) return std::nullopt;
  }
  return pair;
}

void PairMemory::Put(int a, int b, const merge::PairOutcome& outcome) {
  PairRecord pair;
  pair.method = method_;
  pair.keyframes_a = Count(DriveAt(a));
  pair.keyframes_b = Count(DriveAt(b));
  pair.proposed = outcome.proposed;
  pair.evidence = outcome.evidence;
  pair.overlap = outcome.overlap;
  pair.overlap.drive_a = 0;
  pair.overlap.drive_b = 1;
  for (const auto& [key, found] : outcome.asked)
    pair.asked.emplace_back(merge::SubmapKey{key.drive == a ? 0 : 1, key.keyframe}, found);
  store_->database().Put(Table::kPairs, KeyOf(a, b), Encode(pair));
}

int PairMemory::SearchUnknown(merge::SubmapSource* submaps, merge::Progress* progress) {
  std::vector<std::pair<int, int>> unknown;
  const auto refused = RefusedPairs(Rulings(store_), *drives_);
  for (int a = 0; a < static_cast<int>(drives_->size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(drives_->size()); ++b) {
      if (std::find(refused.begin(), refused.end(), std::pair(a, b)) != refused.end()) continue;
      if (!Known(a, b, submaps).has_value()) unknown.emplace_back(a, b);
    }
  }
  merge::PreparedCache prepared(submaps);
  std::mutex report;
  const int count = static_cast<int>(unknown.size());
  int done = 0;
  merge::ParallelFor(count, config_->threads, [&](int i) {
    const auto [a, b] = unknown[static_cast<std::size_t>(i)];
    Put(a, b, merge::SearchPair(*drives_, a, b, &prepared, *config_));
    const std::lock_guard lock(report);
    if (progress != nullptr) progress->Report("pairs", ++done, count);
  });
  return count;
}

void PairMemory::Fill(merge::MergeCache* cache, merge::SubmapSource* submaps) {
  for (int a = 0; a < static_cast<int>(drives_->size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(drives_->size()); ++b) {
      std::optional<PairRecord> pair = Known(a, b, submaps);
      if (!pair.has_value()) continue;
      merge::PairOutcome outcome;
      outcome.overlap = std::move(pair->overlap);
      outcome.overlap.drive_a = a;
      outcome.overlap.drive_b = b;
      outcome.proposed = pair->proposed;
      outcome.evidence = pair->evidence;
      for (const auto& [key, found] : pair->asked) outcome.asked[{key.drive == 0 ? a : b, key.keyframe}] = found;
      cache->StorePair(*drives_, outcome);
    }
  }
  RefuseByHand(Rulings(store_), *drives_, cache);
}

void PairMemory::Keep(const merge::MergeCache& cache, merge::SubmapSource* submaps) {
  merge::PreparedCache prepared(submaps);
  const auto refused = RefusedPairs(Rulings(store_), *drives_);
  store_->Write([&] {
    for (int a = 0; a < static_cast<int>(drives_->size()); ++a) {
      for (int b = a + 1; b < static_cast<int>(drives_->size()); ++b) {
        if (std::find(refused.begin(), refused.end(), std::pair(a, b)) != refused.end()) continue;
        if (!AreStored(a, b) || Known(a, b, submaps).has_value()) continue;
        const auto outcome = cache.FindPair(*drives_, a, b, &prepared);
        if (outcome.has_value()) Put(a, b, *outcome);
      }
    }
  });
}

void RefuseByHand(const std::vector<NumberedRuling>& rulings, const std::vector<merge::Drive>& drives,
                  merge::MergeCache* cache) {
  for (const auto& [a, b] : RefusedPairs(rulings, drives)) {
    merge::PairOutcome outcome;
    outcome.proposed = true;
    outcome.overlap.drive_a = a;
    outcome.overlap.drive_b = b;
    outcome.overlap.test = kLastingTest;
    cache->StorePair(drives, outcome);
  }
}

void NameRefusals(const std::vector<NumberedRuling>& rulings, const std::vector<merge::Drive>& drives,
                  merge::MergeResult* result) {
  for (const auto& [a, b] : RefusedPairs(rulings, drives)) {
    for (merge::Overlap& overlap : result->overlaps) {
      if (overlap.drive_a == a && overlap.drive_b == b) overlap.test = kByHand;
    }
  }
}

bool IsQuarantined(const std::vector<NumberedRuling>& rulings, const std::string& drive) {
  return std::any_of(rulings.begin(), rulings.end(), [&](const NumberedRuling& ruling) {
    return ruling.ruling.kind == Ruling::Kind::kQuarantine && ruling.ruling.drive_a == drive;
  });
}

}  // namespace mapweld::store
