// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/host_checks.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/temporary_directory.hpp"

namespace mapweld::doctor {
namespace {

TEST(ClockSource, IsJudgedByWhatAReadingCosts) {
  EXPECT_EQ(CheckClockSource("tsc", "tsc hpet acpi_pm", 25).verdict, Verdict::kGood);
  const Finding slow = CheckClockSource("hpet", "tsc hpet acpi_pm", 1400);
  EXPECT_EQ(slow.verdict, Verdict::kWarning);
  EXPECT_EQ(slow.repair, "echo tsc > /sys/devices/system/clocksource/clocksource0/current_clocksource");
  EXPECT_EQ(CheckClockSource("jiffies", "jiffies", 5000).verdict, Verdict::kWarning);
  EXPECT_NE(CheckClockSource().what, "") << "of this machine";
}

TEST(StateDirectory, MustBeThereHoldACountAndHaveRoom) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path().string();
  EXPECT_EQ(CheckStateDirectory(path, 1 << 20).verdict, Verdict::kGood) << "no boot yet";
  std::ofstream(directory.File("epoch")) << "17\n";
  EXPECT_EQ(CheckStateDirectory(path, 1 << 20).what, path + " writable, last boot 17");
  EXPECT_EQ(CheckStateDirectory(path, 1ULL << 60U).verdict, Verdict::kFailure);
  std::ofstream(directory.File("epoch")) << "seventeen\n";
  EXPECT_EQ(CheckStateDirectory(path, 1 << 20).verdict, Verdict::kFailure);
  const Finding missing = CheckStateDirectory(path + "/nowhere", 1 << 20);
  EXPECT_EQ(missing.verdict, Verdict::kFailure);
  EXPECT_EQ(missing.repair, "mkdir -p " + path + "/nowhere");
}

TEST(Findings, AreCountedInTextAndJson) {
  const std::vector<Finding> findings{{"one", Verdict::kGood, "fine", ""},
                                      {"two", Verdict::kWarning, "odd", "do this"},
                                      {"three", Verdict::kFailure, "bad \xff", "do that"}};
  EXPECT_EQ(ExitCode(findings), 1);
  const std::string text = FindingsText(findings);
  EXPECT_NE(text.find("checks: 3, failed: 1, warnings: 1"), std::string::npos) << text;
  EXPECT_NE(text.find("repair: do that"), std::string::npos);
  const auto json = nlohmann::json::parse(FindingsJson(findings));
  EXPECT_EQ(json["failed"], 1);
  EXPECT_EQ(json["checks"][2]["verdict"], "failed");
  EXPECT_EQ(json["checks"][1]["repair"], "do this");
}

}  // namespace
}  // namespace mapweld::doctor
