// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace mapweld::merge {

// Told how far a long job is. Calls come one at a time, possibly from different threads.
class Progress {
 public:
  virtual ~Progress() = default;
  virtual void Report(std::string_view stage, int done, int total) = 0;
};

}  // namespace mapweld::merge
