// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/eval_command.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/unit/tools/io/temp_folder.hpp"

namespace mapweld::eval {
namespace {

using ::testing::HasSubstr;

// Errors of the estimate: 0, 0, 0, 0 as drawn; `height` lifts two opposite corners and lowers the others.
std::string Tum(double height) {
  std::string text;
  const double corners[4][2] = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  for (int i = 0; i < 4; ++i) {
    text += fmt::format("{}.5 {} {} {} 0 0 0 1\n", i, corners[i][0], corners[i][1], i % 2 == 0 ? height : -height);
  }
  return text;
}

std::string Output(const std::vector<std::string>& arguments) {
  CLI::App app;
  AddEvalCommand(app);
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  reversed.emplace_back("trajectories");
  reversed.emplace_back("eval");
  testing::internal::CaptureStdout();
  std::string failure;
  try {
    app.parse(reversed);
  } catch (const std::exception& error) {
    failure = error.what();
  }
  const std::string printed = testing::internal::GetCapturedStdout();
  return failure.empty() ? printed : "failed: " + failure;
}

TEST(EvalCommand, PrintsATableOfAllVehicles) {
  const test::TempFolder folder;
  const std::string truth = folder.Put("truth.tum", Tum(0)).string();
  const std::string good = folder.Put("good.tum", Tum(0)).string();
  const std::string bad = folder.Put("bad.tum", Tum(1)).string();
  const std::string table = Output({"--truth", truth, "--estimate", good, "--truth", truth, "--estimate", bad});
  EXPECT_THAT(table, HasSubstr("good           4      0.000"));
  EXPECT_THAT(table, HasSubstr("bad            4      1.000"));
  EXPECT_THAT(table, HasSubstr("all            8      0.707      0.500      0.500      1.000"));
}

TEST(EvalCommand, PrintsJson) {
  const test::TempFolder folder;
  const std::string truth = folder.Put("truth.tum", Tum(0)).string();
  const std::string bad = folder.Put("bad.tum", Tum(1)).string();
  const auto json = nlohmann::json::parse(Output({"--truth", truth, "--estimate", bad, "--json"}));
  EXPECT_NEAR(json["all"]["rmse_m"], 1, 1e-9);
  EXPECT_EQ(json["vehicles"][0]["name"], "bad");
  EXPECT_EQ(json["vehicles"][0]["together"]["poses"], 4);
}

TEST(EvalCommand, ComparesKittiRowsLineByLine) {
  const test::TempFolder folder;
  const std::string rows = "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 5 0 1 0 0 0 0 1 0\n";
  const std::string a = folder.Put("a.txt", rows).string();
  const std::string b = folder.Put("b.txt", rows).string();
  EXPECT_THAT(Output({"--truth", a, "--estimate", b}), HasSubstr("all            2      0.000"));
  const std::string longer = folder.Put("longer.txt", rows + rows).string();
  EXPECT_THAT(Output({"--truth", a, "--estimate", longer}), HasSubstr("must match one to one"));
  const std::string tum = folder.Put("c.tum", Tum(0)).string();
  EXPECT_THAT(Output({"--truth", tum, "--estimate", a}), HasSubstr("c.tum has times and"));
}

TEST(EvalCommand, WantsOneTruthPerEstimate) {
  const test::TempFolder folder;
  const std::string a = folder.Put("a.tum", Tum(0)).string();
  EXPECT_THAT(Output({"--truth", a, "--estimate", a, "--estimate", a}), HasSubstr("1 --truth and 2 --estimate"));
  EXPECT_THAT(Output({"--estimate", a}), HasSubstr("--truth is required"));
}

}  // namespace
}  // namespace mapweld::eval
