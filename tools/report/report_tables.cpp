// SPDX-License-Identifier: Apache-2.0
// The tables of groups and drives, and the chart of stage times.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "tools/report/html_text.hpp"
#include "tools/report/report_parts.hpp"

namespace mapweld::report {
namespace {

constexpr std::string_view kDash = "\xE2\x80\x93";

// Columns keep one unit, so that figures compare at a glance.
std::string Metres(double m) {
  return Count(static_cast<std::uint64_t>(std::llround(std::max(0.0, m))));
}
std::string Kilobytes(double bytes) {
  return Count(static_cast<std::uint64_t>(std::llround(bytes / 1000)));
}

std::string OptionalMetres(const std::vector<std::optional<double>>& values, std::size_t i) {
  return i < values.size() && values[i] ? fmt::format("{:.2f}", *values[i]) : std::string(kDash);
}

bool AnyKnown(const std::vector<std::optional<double>>& values) {
  return std::any_of(values.begin(), values.end(), [](const auto& v) { return v.has_value(); });
}

}  // namespace

std::string GroupsSection(const ReportInput& input) {
  const bool truth = AnyKnown(input.group_rmse_m);
  std::string rows;
  for (std::size_t g = 0; g < input.result->groups.size(); ++g) {
    const std::vector<int>& group = input.result->groups[g];
    std::string members;
    double path_m = 0;
    for (const int drive : group) {
      members += DriveLabel(input, drive) + ' ';
      path_m += DriveLength(input.drives->at(static_cast<std::size_t>(drive)));
    }
    rows += fmt::format(
        "<tr><td class=\"n\">{}</td><td class=\"wrap\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
        "<td class=\"n\">{}</td>",
        g + 1, members, Metres(path_m), Count(KeyframeCount(input, group)), Count(input.maps->at(g).size()));
    if (truth) rows += fmt::format("<td class=\"n\">{}</td>", OptionalMetres(input.group_rmse_m, g));
    rows += "</tr>\n";
  }
  const std::string table = fmt::format(
      "<div class=\"scroll\"><table>\n<tr><th class=\"n\">Map</th><th>Drives</th><th class=\"n\">Driven m</th>"
      "<th class=\"n\">Keyframes</th><th class=\"n\">Points</th>{}</tr>\n{}</table></div>\n",
      truth ? "<th class=\"n\">Rmse m</th>" : "", rows);
  return Section("Groups",
                 "Drives in one row share one coordinate frame; between rows nothing is known, so each row has a frame "
                 "of its own.",
                 table);
}

std::string DrivesSection(const ReportInput& input) {
  const bool truth = AnyKnown(input.drive_rmse_m);
  const bool traffic = std::any_of(input.drive_bytes.begin(), input.drive_bytes.end(), [](auto b) { return b > 0; });
  std::string rows;
  for (std::size_t d = 0; d < input.drives->size(); ++d) {
    const merge::Drive& drive = (*input.drives)[d];
    const double seconds =
        drive.keyframes.empty() ? 0 : (drive.keyframes.back().t - drive.keyframes.front().t).Seconds();
    const auto overlaps =
        std::count_if(input.result->overlaps.begin(), input.result->overlaps.end(), [&](const merge::Overlap& o) {
          return o.accepted && (o.drive_a == static_cast<int>(d) || o.drive_b == static_cast<int>(d));
        });
    rows += fmt::format(
        "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
        "<td class=\"n\">{}</td><td class=\"n\">{}</td>",
        DriveLabel(input, static_cast<int>(d)), input.result->group_of.at(d) + 1, Metres(DriveLength(drive)),
        Duration(seconds), Count(drive.keyframes.size()), overlaps);
    if (truth) rows += fmt::format("<td class=\"n\">{}</td>", OptionalMetres(input.drive_rmse_m, d));
    if (traffic) {
      const double bytes = d < input.drive_bytes.size() ? static_cast<double>(input.drive_bytes[d]) : 0;
      const double path_m = DriveLength(drive);
      rows += fmt::format("<td class=\"n\">{}</td><td class=\"n\">{}</td>", Kilobytes(bytes),
                          path_m > 0 ? Kilobytes(bytes / path_m * 1000) : std::string(kDash));
    }
    rows += "</tr>\n";
  }
  const std::string table = fmt::format(
      "<div class=\"scroll\"><table>\n<tr><th>Drive</th><th class=\"n\">Map</th><th class=\"n\">Length m</th>"
      "<th class=\"n\">Duration</th><th class=\"n\">Keyframes</th><th "
      "class=\"n\">Overlaps</th>{}{}</tr>\n{}</table></div>\n",
      truth ? "<th class=\"n\">Rmse m</th>" : "",
      traffic ? "<th class=\"n\">Sent kB</th><th class=\"n\">kB per km</th>" : "", rows);
  std::string how = "One row per recording, with the colour and number it has on the map.";
  if (truth) how += " Rmse is the position error after one alignment of its whole map to the truth.";
  return Section("Drives", how, table);
}

std::string TimesSection(const ReportInput& input) {
  if (input.result->times.empty()) return "";
  double longest = 0;
  double total = 0;
  for (const merge::StageTime& stage : input.result->times) {
    longest = std::max(longest, stage.seconds);
    total += stage.seconds;
  }
  std::string bars;
  for (const merge::StageTime& stage : input.result->times) {
    const double share = longest > 0 ? stage.seconds / longest : 0;
    bars += fmt::format(
        "<span>{}</span><div class=\"bar\"><i style=\"width:{:.2f}%\"></i></div><span class=\"n\">{}</span>"
        "<span class=\"n faint\">{:.0f} %</span>\n",
        EscapeHtml(stage.stage), std::max(0.3, 100 * share), Duration(stage.seconds),
        total > 0 ? 100 * stage.seconds / total : 0.0);
  }
  return Section(
      "Where the time went",
      fmt::format("Wall-clock time of each stage on the host, in the order they ran; {} in all.", Duration(total)),
      "<div class=\"bars\">\n" + bars + "</div>\n");
}

}  // namespace mapweld::report
