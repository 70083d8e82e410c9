// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace mapweld::doctor {

enum class Verdict { kGood, kWarning, kFailure };

// What one check found, and the command that repairs it; no command when nothing is wrong.
struct Finding {
  std::string check;
  Verdict verdict = Verdict::kGood;
  std::string what;
  std::string repair;
};

// Every finding as a line, repairs below; the last line counts them.
std::string FindingsText(const std::vector<Finding>& findings);
std::string FindingsJson(const std::vector<Finding>& findings);

// 0 when no finding is a failure, else 1.
int ExitCode(const std::vector<Finding>& findings);

}  // namespace mapweld::doctor
