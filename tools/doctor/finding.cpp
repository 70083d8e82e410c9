// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/finding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace mapweld::doctor {
namespace {

const char* Word(Verdict verdict) {
  if (verdict == Verdict::kGood) return "ok";
  return verdict == Verdict::kWarning ? "warning" : "FAILED";
}

std::ptrdiff_t Count(const std::vector<Finding>& findings, Verdict verdict) {
  return std::ranges::count(findings, verdict, &Finding::verdict);
}

}  // namespace

std::string FindingsText(const std::vector<Finding>& findings) {
  std::string out;
  for (const Finding& finding : findings) {
    out += fmt::format("{:<8} {:<18} {}\n", Word(finding.verdict), finding.check, finding.what);
    if (!finding.repair.empty()) out += fmt::format("{:<27} repair: {}\n", "", finding.repair);
  }
  return out + fmt::format("checks: {}, failed: {}, warnings: {}\n", findings.size(),
                           Count(findings, Verdict::kFailure), Count(findings, Verdict::kWarning));
}

std::string FindingsJson(const std::vector<Finding>& findings) {
  nlohmann::ordered_json json{{"failed", Count(findings, Verdict::kFailure)},
                              {"warnings", Count(findings, Verdict::kWarning)},
                              {"checks", nlohmann::ordered_json::array()}};
  for (const Finding& finding : findings) {
    const char* verdict = finding.verdict == Verdict::kFailure ? "failed" : Word(finding.verdict);
    json["checks"].push_back(
        {{"check", finding.check}, {"verdict", verdict}, {"what", finding.what}, {"repair", finding.repair}});
  }
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

int ExitCode(const std::vector<Finding>& findings) {
  return Count(findings, Verdict::kFailure) > 0 ? 1 : 0;
}

}  // namespace mapweld::doctor
