// SPDX-License-Identifier: Apache-2.0
// What a reader in a hurry wants: one sentence, and a row of figures.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "tools/report/html_text.hpp"
#include "tools/report/report_parts.hpp"

namespace mapweld::report {
namespace {

std::string GroupsSentence(const ReportInput& input) {
  const std::size_t drives = input.drives->size();
  if (drives == 0) return "No drives were given.";
  std::vector<std::size_t> maps;  // sizes of groups with more than one drive
  for (const std::vector<int>& group : input.result->groups) {
    if (group.size() > 1) maps.push_back(group.size());
  }
  std::size_t merged = 0;
  for (const std::size_t size : maps) merged += size;
  const std::size_t alone = drives - merged;
  if (maps.empty()) {
    return drives == 1 ? "One drive; nothing to merge it with."
                       : fmt::format("None of the {} drives could be shown to overlap with another.", Count(drives));
  }
  if (maps.size() == 1 && alone == 0) return fmt::format("All {} drives form one map.", Count(drives));
  std::string text;
  if (maps.size() == 1) {
    text = fmt::format("{} of {} drives form one map", Count(merged), Count(drives));
  } else {
    std::vector<std::string> sizes;
    for (std::size_t i = 0; i < maps.size() && i < 6; ++i) sizes.push_back(Count(maps[i]));
    const bool all_named = sizes.size() == maps.size();
    text = fmt::format("{} of {} drives form {} maps{}", Count(merged), Count(drives), Count(maps.size()),
                       all_named ? fmt::format(" of {}", Enumerate(sizes)) : "");
  }
  if (alone == 1) text += "; one shares no verified street with the others";
  if (alone > 1) text += fmt::format("; {} share no verified street with any other", Count(alone));
  return text + ".";
}

std::string Verdict(const ReportInput& input) {
  std::string text = GroupsSentence(input);
  if (!input.group_rmse_m.empty() && input.group_rmse_m.front()) {
    text += fmt::format(" {} {} from the truth (rmse).", input.result->groups.size() == 1 ? "It is" : "The largest is",
                        Length(*input.group_rmse_m.front()));
  }
  return text;
}

std::string Tile(std::string_view label, std::string_view value, std::string_view note = "") {
  return fmt::format("<div class=\"tile\"><dt>{}</dt><dd>{}</dd><small>{}</small></div>\n", label, value, note);
}

std::string Tiles(const ReportInput& input) {
  const merge::MergeResult& result = *input.result;
  std::size_t keyframes = 0;
  double path_m = 0;
  for (const merge::Drive& drive : *input.drives) {
    keyframes += drive.keyframes.size();
    path_m += DriveLength(drive);
  }
  const std::size_t largest = result.groups.empty() ? 0 : result.groups.front().size();
  const auto accepted = static_cast<std::size_t>(std::count_if(result.overlaps.begin(), result.overlaps.end(),
                                                               [](const merge::Overlap& o) { return o.accepted; }));
  std::size_t points = 0;
  for (const auto& map : *input.maps) points += map.size();
  double seconds = 0;
  for (const merge::StageTime& stage : result.times) seconds += stage.seconds;
  std::uint64_t bytes = 0;
  for (const std::uint64_t b : input.drive_bytes) bytes += b;

  std::string tiles;
  tiles += Tile("Drives", Count(input.drives->size()), fmt::format("{} driven", Length(path_m)));
  tiles += Tile("Maps", Count(result.groups.size()), fmt::format("{} in the largest", Plural(largest, "drive")));
  tiles += Tile("Overlaps", Count(accepted), fmt::format("{} rejected", Count(result.overlaps.size() - accepted)));
  tiles += Tile("Keyframes", Count(keyframes), "one every 5 m or so");
  tiles += Tile("Map points", Count(points), "after thinning");
  if (!input.group_rmse_m.empty() && input.group_rmse_m.front()) {
    tiles += Tile("Error", Length(*input.group_rmse_m.front()), "rmse of the largest map");
  }
  if (bytes > 0 && path_m > 0) {
    tiles += Tile("Over the air", Bytes(static_cast<double>(bytes) / path_m * 1000) + "/km",
                  fmt::format("{} in all", Bytes(static_cast<double>(bytes))));
  }
  if (!result.times.empty()) tiles += Tile("Computed in", Duration(seconds), "on the host");
  return "<dl class=\"tiles\">\n" + tiles + "</dl>\n";
}

}  // namespace

std::string SummarySection(const ReportInput& input) {
  std::string html = fmt::format("<header>\n<h1>{}</h1>\n<p class=\"verdict\">{}</p>\n</header>\n",
                                 EscapeHtml(input.title), Verdict(input));
  if (!input.result->missing.empty()) {
    const std::size_t missing = input.result->missing.size();
    html += fmt::format(
        "<p class=\"warning\">{} had not arrived when this merge was made. Merging again with {} may add "
        "overlaps.</p>\n",
        Plural(missing, "submap"), missing == 1 ? "it" : "them");
  }
  return html + Tiles(input);
}

}  // namespace mapweld::report
