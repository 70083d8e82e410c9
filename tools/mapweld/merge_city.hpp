// SPDX-License-Identifier: Apache-2.0
// The drives that one `mapweld merge` puts together: either what it was given, in memory, or all that a store holds.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tools/io/tum.hpp"
#include "tools/mapweld/merge_inputs.hpp"
#include "tools/merge/crew.hpp"
#include "tools/merge/merge_config.hpp"
#include "tools/merge/merge_result.hpp"

namespace mapweld::merge {

class MergeCity : public SubmapSource {
 public:
  // By name.
  [[nodiscard]] const std::vector<Drive>& drives() const { return drives_; }
  virtual MergeResult Merge(const MergeConfig& config, Progress* progress) = 0;
  // Per drive, one merged pose for every scan; empty for what has keyframes only.
  [[nodiscard]] std::vector<std::vector<io::StampedPose>> Trajectories(const MergeResult& result);

 protected:
  virtual store::ScanTrajectory Scans(std::size_t drive) = 0;
  std::vector<Drive> drives_;
};

// Builds all inputs. crew: who merges them, and must outlive the city; null for the threads of this process.
std::unique_ptr<MergeCity> CityInMemory(const std::vector<MergeInput>& inputs, Crew* crew);

// Builds the inputs that the store does not hold yet, and keeps each as soon as it is built; the same for every pair of
// drives that is searched, and for the result. What was interrupted goes on where it was. Drives in quarantine are left
// out. Throws store::StoreError when an input has the name of another drive.
std::unique_ptr<MergeCity> CityInStore(const std::filesystem::path& store, const std::vector<MergeInput>& inputs,
                                       Progress* progress);

}  // namespace mapweld::merge
