// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/places_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/unit/tools/io/temp_folder.hpp"
#include "tools/describe/place_table.hpp"

namespace mapweld::eval {
namespace {

using ::testing::HasSubstr;

// Twice around a circle of 480 m, a keyframe every 12 m; the descriptor says where on it, and is shifted by `error`
// keyframes the second time.
std::vector<describe::PlaceRow> TwoRounds(int error) {
  std::vector<describe::PlaceRow> rows;
  for (int i = 0; i < 80; ++i) {
    describe::PlaceRow row;
    row.scan = i;
    const double at = 2 * M_PI * i / 40;
    row.position = {240 / M_PI * std::cos(at), 240 / M_PI * std::sin(at), 0};
    row.place.descriptor.scale = 1;
    std::mt19937 of_place(static_cast<unsigned>((i + (i < 40 ? 0 : error)) % 40));
    for (std::int8_t& q : row.place.descriptor.q) q = static_cast<std::int8_t>(of_place() % 255 - 127);
    rows.push_back(row);
  }
  return rows;
}

std::string Output(const std::vector<std::string>& arguments) {
  CLI::App app;
  AddPlacesCommand(app);
  std::vector<const char*> argv = {"eval", "places"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  testing::internal::CaptureStdout();
  const std::string failure = test::ErrorOf([&] { app.parse(static_cast<int>(argv.size()), argv.data()); });
  const std::string printed = testing::internal::GetCapturedStdout();
  return failure.empty() ? printed : "failed: " + failure;
}

TEST(PlacesCommand, ComparesTablesByName) {
  const test::TempFolder folder;
  WritePlaceTable(folder / "right.csv", TwoRounds(0));
  WritePlaceTable(folder / "wrong.csv", TwoRounds(7));
  const std::string out = Output({"ours=" + (folder / "right.csv").string(), (folder / "wrong.csv").string()});
  EXPECT_THAT(out, HasSubstr("ours               80       40 1.000"));
  EXPECT_THAT(out, HasSubstr("wrong              80       40 0.000"));
}

TEST(PlacesCommand, TakesTablesOfOneNameAsSessionsOfOneWorld) {
  const test::TempFolder folder;
  WritePlaceTable(folder / "monday.csv", TwoRounds(0));
  WritePlaceTable(folder / "tuesday.csv", TwoRounds(0));
  const auto json = nlohmann::json::parse(
      Output({"a=" + (folder / "monday.csv").string(), "a=" + (folder / "tuesday.csv").string(), "--json"}));
  const auto& a = json["descriptors"][0];
  EXPECT_EQ(a["sessions"], 2);
  EXPECT_EQ(a["keyframes"], 160);
  EXPECT_EQ(a["radii"][1]["radius_m"], 10);
  EXPECT_EQ(a["radii"][1]["all"]["queries"], 160);
  EXPECT_EQ(a["radii"][1]["all"]["recall_at_1"], 1);
  EXPECT_EQ(a["radii"][1]["forward"]["queries"], 160);
}

TEST(PlacesCommand, CountsKeyframesWithoutDescriptor) {
  const test::TempFolder folder;
  std::vector<describe::PlaceRow> rows = TwoRounds(0);
  for (std::size_t i = 40; i < 50; ++i) rows[i].place.descriptor.scale = 0;
  WritePlaceTable(folder / "t.csv", rows);
  const std::string out = Output({(folder / "t.csv").string()});
  EXPECT_THAT(out, HasSubstr("t: 10 keyframes have no descriptor and count as missed."));
  EXPECT_THAT(out, HasSubstr("40 0.750"));
}

TEST(PlacesCommand, SaysInOneSentenceWhatIsWrong) {
  const test::TempFolder folder;
  WritePlaceTable(folder / "t.csv", TwoRounds(0));
  std::vector<describe::PlaceRow> two = TwoRounds(0);
  two.resize(2);
  WritePlaceTable(folder / "two.csv", two);
  EXPECT_THAT(Output({(folder / "two.csv").string()}), HasSubstr("two.csv has 2 keyframes"));
  EXPECT_THAT(Output({(folder / "none.csv").string()}), HasSubstr("none.csv"));
  EXPECT_THAT(Output({(folder / "t.csv").string(), "--variant", "solid"}), HasSubstr("--variant is for recordings"));
  EXPECT_THAT(Output({folder.path().string(), "--variant", "sollid"}), HasSubstr("there is no descriptor 'sollid'"));
  EXPECT_THAT(Output({folder.path().string(), "--variant", "published"}), HasSubstr("is no LCM log"));
  EXPECT_THAT(Output({folder.Put("empty.lcm", "").string(), "--variant", "solid"}), HasSubstr("empty.lcm"));
}

}  // namespace
}  // namespace mapweld::eval
