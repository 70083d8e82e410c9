// SPDX-License-Identifier: Apache-2.0
#include "tools/report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/unit/tools/io/temp_folder.hpp"
#include "tests/unit/tools/report/fake_town.hpp"
#include "tools/io/text_rows.hpp"
#include "tools/report/palette.hpp"

namespace mapweld::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A town with everything the report can show.
struct Scene {
  test::FakeTown town;
  std::vector<std::vector<MapPoint>> maps;
  ReportInput input;

  Scene(int drives, int keyframes) : town(drives, keyframes) {
    for (std::size_t g = 0; g < town.result.groups.size(); ++g) {
      maps.push_back(BuildGroupMap(town.drives, town.result, static_cast<int>(g), &town));
    }
    input.title = "Two cars & a <street>";
    input.drives = &town.drives;
    input.result = &town.result;
    input.maps = &maps;
  }
};

std::size_t CountOf(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

// Empty when every element that opens also closes, in order; else what is wrong.
std::string TagProblem(const std::string& html) {
  static const std::set<std::string> kVoid = {"meta", "br", "img"};
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const std::size_t end = html.find('>', at);
    if (end == std::string::npos) return "a tag without an end";
    const std::string tag = html.substr(at + 1, end - at - 1);
    const bool closing = tag.starts_with('/');
    const std::string name = tag.substr(closing ? 1 : 0, tag.find_first_of(" /\n", 1) - (closing ? 1 : 0));
    if (tag.starts_with('!') || tag.ends_with('/') || kVoid.contains(name)) continue;
    if (!closing) {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return "</" + name + "> closes " + (open.empty() ? "nothing" : open.back());
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> stays open";
}

// Without the pictures, whose text is long and means nothing to a test.
std::string WithoutPictures(const std::string& html) {
  std::string out;
  std::size_t at = 0;
  for (std::size_t begin = html.find("data:image"); begin != std::string::npos; begin = html.find("data:image", at)) {
    out += html.substr(at, begin - at);
    at = html.find('"', begin);
  }
  return out + html.substr(at);
}

TEST(Report, IsOneFileThatNeedsNothingElse) {
  const Scene scene(4, 130);
  const std::string html = WithoutPictures(ReportHtml(scene.input));
  EXPECT_THAT(html, Not(HasSubstr("http")));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("src=")));
  EXPECT_THAT(html, Not(HasSubstr("url(")));
  EXPECT_THAT(html, Not(HasSubstr("@import")));
  EXPECT_EQ(CountOf(html, "href="), CountOf(html, "href=\"\"")) << "a link that leads out of the file";
}

TEST(Report, ClosesEveryElement) {
  Scene scene(9, 130);
  scene.town.result.missing.push_back({0, 1});
  EXPECT_EQ(TagProblem(WithoutPictures(ReportHtml(scene.input))), "");
}

TEST(Report, ShowsEveryPartOfTheMerge) {
  Scene scene(4, 130);
  scene.input.group_rmse_m = {0.213, std::nullopt};
  scene.input.drive_rmse_m = {0.1, 0.2, 0.3, std::nullopt};
  scene.input.drive_bytes = {1'000'000, 500'000, 0, 0};
  scene.input.footnote = "mapweld 0.1.0";
  const std::string html = WithoutPictures(ReportHtml(scene.input));
  EXPECT_THAT(html, HasSubstr("3 of 4 drives form one map; one shares no verified street with the others."));
  EXPECT_THAT(html, HasSubstr("21 cm from the truth"));
  EXPECT_THAT(html, HasSubstr("<dt>Over the air</dt><dd>581 kB/km</dd>"));
  for (const merge::Drive& drive : scene.town.drives) EXPECT_THAT(html, HasSubstr(drive.name));
  for (const merge::StageTime& stage : scene.town.result.times) EXPECT_THAT(html, HasSubstr(stage.stage));
  EXPECT_EQ(CountOf(html, "<figure class=\"map"), 2U);
  EXPECT_EQ(CountOf(html, "class=\"drive\""), 4U);
  EXPECT_THAT(html, HasSubstr("accepted</td><td>registration"));
  EXPECT_THAT(html, HasSubstr("mapweld 0.1.0"));
}

TEST(Report, MarksProposedAndConfirmedMatchesOfAcceptedPairsOnly) {
  const Scene scene(3, 130);
  std::size_t matches = 0;
  std::size_t loops = 0;
  std::size_t cards = 0;
  for (const merge::Overlap& overlap : scene.town.result.overlaps) {
    if (!overlap.accepted) continue;
    ++cards;
    matches += overlap.matches.size();
    loops += overlap.loops.size();
  }
  ASSERT_GT(loops, 0U);
  ASSERT_LT(cards, scene.town.result.differences.size()) << "the town needs a rejected pair";
  const std::string html = WithoutPictures(ReportHtml(scene.input));
  EXPECT_EQ(CountOf(html, "class=\"card\""), cards);
  EXPECT_EQ(CountOf(html, "class=\"match\""), matches);
  EXPECT_EQ(CountOf(html, "class=\"loop\""), loops);
}

TEST(Report, SaysWhenNothingBelongsTogether) {
  Scene scene(2, 10);
  EXPECT_THAT(ReportHtml(scene.input), HasSubstr("None of the 2 drives could be shown to overlap with another."));
  Scene one(1, 10);
  EXPECT_THAT(ReportHtml(one.input), HasSubstr("One drive; nothing to merge it with."));
}

TEST(Report, CountsSeveralMaps) {
  Scene scene(7, 5);
  scene.town.result.groups = {{0, 1, 2}, {3, 4}, {5}, {6}};
  scene.maps.resize(4);
  EXPECT_THAT(ReportHtml(scene.input),
              HasSubstr("5 of 7 drives form 2 maps of 3 and 2; 2 share no verified street with any other."));
}

TEST(Report, WarnsAboutSubmapsThatHadNotArrived) {
  Scene scene(2, 5);
  EXPECT_THAT(ReportHtml(scene.input), Not(HasSubstr("had not arrived")));
  scene.town.result.missing = {{0, 1}, {0, 2}};
  EXPECT_THAT(ReportHtml(scene.input), HasSubstr("2 submaps had not arrived"));
}

TEST(Report, EscapesNames) {
  Scene scene(2, 10);
  scene.town.drives[0].name = "<script>alert(\"x\")</script>";
  const std::string html = ReportHtml(scene.input);
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;"));
  EXPECT_THAT(html, HasSubstr("<title>Two cars &amp; a &lt;street&gt;</title>"));
  EXPECT_EQ(TagProblem(WithoutPictures(html)), "");
}

TEST(Report, SurvivesAMergeOfNothingAndDrivesWithoutKeyframes) {
  const std::vector<merge::Drive> none;
  const merge::MergeResult empty;
  const std::vector<std::vector<MapPoint>> no_maps;
  ReportInput input;
  EXPECT_NE(test::ErrorOf([&] { (void)ReportHtml(input); }), "");
  input.drives = &none;
  input.result = &empty;
  input.maps = &no_maps;
  EXPECT_THAT(ReportHtml(input), HasSubstr("No drives were given."));

  Scene scene(2, 0);
  const std::string html = WithoutPictures(ReportHtml(scene.input));
  EXPECT_EQ(TagProblem(html), "");
  EXPECT_THAT(html, Not(HasSubstr("nan")));
}

TEST(Report, IsTheSameForTheSameMergeAndReplacesTheOldFile) {
  const test::TempFolder folder;
  const Scene one(3, 40);
  const Scene two(3, 40);
  folder.Put("report.html", "old");
  WriteReport(folder / "report.html", one.input);
  EXPECT_EQ(io::ReadFile(folder / "report.html"), ReportHtml(two.input));
  EXPECT_THAT(folder.Files(), ::testing::ElementsAre("report.html"));
}

TEST(Palette, TellsTwentyOneDrivesApart) {
  std::set<std::string> looks;
  for (int drive = 0; drive < 3 * kPaletteColors; ++drive) {
    looks.insert(DriveColorHex(drive) + "/" + DriveDashes(drive, 2));
  }
  EXPECT_EQ(looks.size(), 3U * kPaletteColors);
}

}  // namespace
}  // namespace mapweld::report
