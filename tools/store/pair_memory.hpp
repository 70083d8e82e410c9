// SPDX-License-Identifier: Apache-2.0
// What earlier merges found between pairs of drives, so that a drive added tomorrow is searched against the city, and
// the city not against itself. The result is the same as without it.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/merge/merge_cache.hpp"
#include "tools/merge/progress.hpp"
#include "tools/store/city_store.hpp"
#include "tools/store/history.hpp"

namespace mapweld::store {

class PairMemory {
 public:
  // keys: of `drives` in the store, 0 for one that is not in it. All must outlive it.
  PairMemory(CityStore* store, const std::vector<merge::Drive>* drives, std::vector<DriveKey> keys,
             const merge::MergeConfig* config);

  // Searches every pair that is not known, on config.threads threads, and keeps each as soon as it is found: what is
  // interrupted goes on where it was. Gives the number searched.
  int SearchUnknown(merge::SubmapSource* submaps, merge::Progress* progress);
  // Puts what is known, and what people ruled, into the cache of a merge.
  void Fill(merge::MergeCache* cache, merge::SubmapSource* submaps);
  // Keeps what a merge found, in one transaction.
  void Keep(const merge::MergeCache& cache, merge::SubmapSource* submaps);

 private:
  [[nodiscard]] std::optional<PairRecord> Known(int a, int b, merge::SubmapSource* submaps);
  void Put(int a, int b, const merge::PairOutcome& outcome);
  [[nodiscard]] std::int64_t KeyOf(int a, int b) const;
  [[nodiscard]] bool AreStored(int a, int b) const {
    return keys_[static_cast<std::size_t>(a)] != 0 && keys_[static_cast<std::size_t>(b)] != 0;
  }
  [[nodiscard]] const merge::Drive& DriveAt(int i) const { return (*drives_)[static_cast<std::size_t>(i)]; }

  CityStore* store_;
  const std::vector<merge::Drive>* drives_;
  std::vector<DriveKey> keys_;
  const merge::MergeConfig* config_;
  std::uint64_t method_;
};

// Makes the merge refuse what people refused: an outcome that stands for the search of the pair.
void RefuseByHand(const std::vector<NumberedRuling>& rulings, const std::vector<merge::Drive>& drives,
                  merge::MergeCache* cache);
// Gives the pairs so refused their true reason in the result.
void NameRefusals(const std::vector<NumberedRuling>& rulings, const std::vector<merge::Drive>& drives,
                  merge::MergeResult* result);
// Has somebody set the drive aside?
bool IsQuarantined(const std::vector<NumberedRuling>& rulings, const std::string& drive);

}  // namespace mapweld::store
