// SPDX-License-Identifier: Apache-2.0
// A made-up merge for tests: drives through a town of rectangular blocks, with their submaps, overlaps and groups.
#pragma once

#include <vector>

#include "tools/merge/drive.hpp"
#include "tools/merge/merge_result.hpp"

namespace mapweld::test {

class FakeTown : public merge::SubmapSource {
 public:
  // `drives` of about `keyframes` each. Neighbouring drives share a street; the last drive stays alone.
  FakeTown(int drives, int keyframes);

  std::vector<merge::Drive> drives;
  merge::MergeResult result;

  std::shared_ptr<const merge::SubmapCloud> Find(merge::SubmapKey key) override;

 private:
  std::vector<std::vector<merge::SubmapCloud>> submaps_;
};

}  // namespace mapweld::test
