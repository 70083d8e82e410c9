// SPDX-License-Identifier: Apache-2.0
#include "tools/report/summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mapweld::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Summary ThreeDrives() {
  Summary out;
  for (const int group : {1, 1, 2}) {
    DriveSummary drive;
    drive.name = "agent_" + std::to_string(out.drives.size() + 1);
    drive.group = group;
    drive.path_m = 2000;
    drive.rmse_m = 1.5;
    out.drives.push_back(drive);
  }
  out.groups = 2;
  out.group_rmse_m = {2.0, 0.5};
  return out;
}

TEST(SummaryTable, TellsTheErrorOfAGroupAsAShareOfItsLength) {
  const std::string table = SummaryTable(ThreeDrives());
  EXPECT_THAT(table, HasSubstr("group 1: 2 drives, 4.00 km, rmse 2.000 m, 0.0500 % of its length\n"));
  EXPECT_THAT(table, Not(HasSubstr("group 2:"))) << "a drive alone has its own line already";
}

TEST(SummaryTable, SaysNothingOfGroupsWithoutTruth) {
  Summary summary = ThreeDrives();
  summary.group_rmse_m = {std::nullopt, std::nullopt};
  EXPECT_THAT(SummaryTable(summary), Not(HasSubstr("group 1:")));
}

TEST(SummaryJson, HasTheErrorOfEveryGroup) {
  Summary summary = ThreeDrives();
  summary.group_rmse_m[1] = std::nullopt;
  EXPECT_THAT(SummaryJson(summary), HasSubstr("\"group_rmse_m\": [\n    2.0,\n    null\n  ]"));
}

}  // namespace
}  // namespace mapweld::report
