// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "tools/merge/progress.hpp"

namespace mapweld::merge {

// Progress on stderr: one line that is written over on a terminal, elsewhere one
// line per finished stage and every ten seconds.
class TerminalProgress final : public Progress {
 public:
  explicit TerminalProgress(std::string command);
  // What the next stages work on, for example the name of a recording; may be empty.
  void SetSubject(std::string subject) { subject_ = std::move(subject); }
  // From now on it says nothing: another process tells the same.
  void Silence() { silent_ = true; }
  void Report(std::string_view stage, int done, int total) override;
  // Ends an unfinished line.
  void Finish();

 private:
  std::string command_;
  std::string subject_;
  bool terminal_;
  bool silent_ = false;
  bool line_open_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace mapweld::merge
