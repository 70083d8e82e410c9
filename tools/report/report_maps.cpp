// SPDX-License-Identifier: Apache-2.0
// One picture per group: the cloud from above, the drives over it, a scale bar and a legend.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/report/html_text.hpp"
#include "tools/report/map_image.hpp"
#include "tools/report/palette.hpp"
#include "tools/report/report_parts.hpp"

namespace mapweld::report {
namespace {

constexpr std::size_t kMostPictures = 13;
constexpr double kFullWidth = 1120;
constexpr double kHalfWidth = 540;
constexpr double kLineWidth = 2.6;
constexpr double kBadgeRadius = 10;

using Drawing = std::vector<Eigen::Vector2d>;

// Streets driven several times keep their lines apart: each is drawn a few units aside.
Eigen::Vector2d Aside(std::size_t index) {
  const double step = static_cast<double>(index % 3) - 1;
  return {1.9 * step, -1.9 * step};
}

// Points closer than half a unit add nothing that can be seen.
Drawing Path(const std::vector<geom::Pose3>& merged_T_body, const MapView& view, const Eigen::Vector2d& aside) {
  Drawing path;
  for (const geom::Pose3& pose : merged_T_body) {
    const Eigen::Vector2d p = view.ToDrawing(pose.t) + aside;
    if (path.empty() || (p - path.back()).norm() > 0.5 || &pose == &merged_T_body.back()) path.push_back(p);
  }
  return path;
}

std::string Polyline(const Drawing& path, std::string_view attributes, std::string_view title) {
  std::string points;
  for (const Eigen::Vector2d& p : path) points += fmt::format("{:.1f},{:.1f} ", p.x(), p.y());
  return fmt::format("<polyline points=\"{}\" {}>{}</polyline>\n", points, attributes, title);
}

// A dot where the drive starts, and its number beside the path: as near to the start as fits without covering others.
std::string StartMarker(int drive, const Drawing& path, Drawing* taken) {
  const Eigen::Vector2d start = path.front();
  Eigen::Vector2d best = start;
  double best_gap = -1;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Eigen::Vector2d ahead = path[std::min(i + 1, path.size() - 1)] - path[i > 0 ? i - 1 : 0];
    const Eigen::Vector2d side =
        ahead.norm() > 0 ? Eigen::Vector2d(-ahead.y(), ahead.x()).normalized() : Eigen::Vector2d(0, -1);
    for (const double offset : {-16.0, 16.0}) {
      const Eigen::Vector2d candidate = path[i] + offset * side;
      double gap = 1e9;
      for (const Eigen::Vector2d& other : *taken) gap = std::min(gap, (candidate - other).norm());
      if (gap > best_gap) {
        best = candidate;
        best_gap = gap;
      }
      if (best_gap > 2.4 * kBadgeRadius) break;
    }
    if (best_gap > 2.4 * kBadgeRadius) break;
  }
  taken->push_back(best);
  const std::string color = DriveColorHex(drive);
  return fmt::format(
      "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"5\" fill=\"{2}\" class=\"cased\"/>"
      "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{3:.1f}\" y2=\"{4:.1f}\" stroke=\"{2}\" stroke-width=\"1.5\"/>"
      "<circle cx=\"{3:.1f}\" cy=\"{4:.1f}\" r=\"{5}\" fill=\"{2}\" class=\"cased\"/>"
      "<text x=\"{3:.1f}\" y=\"{4:.1f}\" dy=\".36em\" class=\"badge\">{6}</text>\n",
      start.x(), start.y(), color, best.x(), best.y(), kBadgeRadius, drive + 1);
}

// Bands along the keyframes of the first drive of each accepted pair that registration confirmed. A gap of some
// keyframes does not break a band: not every match of a shared street is registered.
std::string WeldBands(const ReportInput& input, const std::vector<int>& drives, const MapView& view) {
  constexpr int kLongestGap = 12;
  std::string bands;
  for (const merge::Overlap& overlap : input.result->overlaps) {
    if (!overlap.accepted || !std::binary_search(drives.begin(), drives.end(), overlap.drive_a)) continue;
    const auto& merged_T_body = input.result->merged_T_body.at(static_cast<std::size_t>(overlap.drive_a));
    std::vector<int> keyframes;
    for (const merge::Loop& loop : overlap.loops) keyframes.push_back(loop.keyframe_a);
    std::sort(keyframes.begin(), keyframes.end());
    for (std::size_t i = 0; i < keyframes.size();) {
      std::size_t end = i + 1;
      while (end < keyframes.size() && keyframes[end] - keyframes[end - 1] <= kLongestGap) ++end;
      Drawing band;
      for (int k = keyframes[i]; k <= keyframes[end - 1]; ++k) {
        band.push_back(view.ToDrawing(merged_T_body.at(static_cast<std::size_t>(k)).t));
      }
      if (band.size() == 1) band.push_back(band.front() + Eigen::Vector2d(0.1, 0));  // a lone one shows as a dot
      bands += Polyline(band, "class=\"weld\"", "");
      i = end;
    }
  }
  return bands;
}

// The round length that takes about a sixth of the width.
std::string ScaleBar(const MapView& view) {
  const double aim_m = view.width * view.m_per_unit / 6;
  double length_m = std::pow(10, std::floor(std::log10(aim_m)));
  for (const double factor : {10.0, 5.0, 2.0}) {
    if (length_m * factor <= aim_m * 1.3) {
      length_m *= factor;
      break;
    }
  }
  const double width = length_m / view.m_per_unit;
  const double y = view.height - 18;
  const std::string text = length_m >= 1000 ? fmt::format("{:g} km", length_m / 1000) : fmt::format("{:g} m", length_m);
  return fmt::format(
      "<g class=\"scale\"><rect x=\"12\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"34\" rx=\"6\" class=\"plate\"/>"
      "<path d=\"M22 {:.1f}v6h{:.1f}v-6\"/><text x=\"{:.1f}\" y=\"{:.1f}\">{}</text></g>\n",
      y - 22, width + 20, y - 3, width, 22 + width / 2, y - 6, text);
}

std::string LegendEntry(const ReportInput& input, int drive) {
  const std::string dashes = DriveDashes(drive, kLineWidth);
  return fmt::format(
      "<li title=\"{0}\"><svg width=\"30\" height=\"8\" aria-hidden=\"true\"><line x1=\"0\" y1=\"4\" x2=\"30\" "
      "y2=\"4\" "
      "stroke=\"{1}\" stroke-width=\"3\" stroke-dasharray=\"{2}\"/></svg>{3}<span class=\"name\">{0}</span>"
      "<span class=\"faint\">{4}</span></li>\n",
      EscapeHtml(input.drives->at(static_cast<std::size_t>(drive)).name), DriveColorHex(drive), dashes,
      DriveBadge(drive), Length(DriveLength(input.drives->at(static_cast<std::size_t>(drive)))));
}

std::string GroupPicture(const ReportInput& input, std::size_t group, double width) {
  const std::vector<int>& drives = input.result->groups[group];
  const std::vector<MapPoint>& points = input.maps->at(group);
  std::vector<std::vector<geom::Pose3>> trajectories;
  for (const int drive : drives)
    trajectories.push_back(input.result->merged_T_body.at(static_cast<std::size_t>(drive)));
  const MapView view = FitView(points, trajectories, width, 0.75 * width);
  std::string svg;
  if (!points.empty()) {
    svg += fmt::format("<image href=\"{}\" width=\"{:.1f}\" height=\"{:.1f}\" preserveAspectRatio=\"none\"/>\n",
                       PngDataUri(RenderMap(points, view)), view.width, view.height);
  }
  std::string casings;
  std::string lines;
  std::string markers;
  std::string legend;
  Drawing taken;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const Drawing path = Path(trajectories[i], view, drives.size() > 1 ? Aside(i) : Eigen::Vector2d::Zero());
    if (path.empty()) continue;
    const std::string name = EscapeHtml(input.drives->at(static_cast<std::size_t>(drives[i])).name);
    casings += Polyline(path, "class=\"casing\"", "");
    lines += Polyline(path,
                      fmt::format("class=\"drive\" stroke=\"{}\" stroke-width=\"{}\" stroke-dasharray=\"{}\"",
                                  DriveColorHex(drives[i]), kLineWidth, DriveDashes(drives[i], kLineWidth)),
                      fmt::format("<title>{}</title>", name));
    markers += StartMarker(drives[i], path, &taken);
    legend += LegendEntry(input, drives[i]);
  }
  svg += WeldBands(input, drives, view) + casings + lines + markers + ScaleBar(view);
  const std::string caption = drives.size() == 1
                                  ? fmt::format("<b>Map {}</b> one drive on its own", group + 1)
                                  : fmt::format("<b>Map {}</b> {}, {}", group + 1, Plural(drives.size(), "drive"),
                                                Plural(points.size(), "point"));
  return fmt::format(
      "<figure class=\"map{}\">\n<svg viewBox=\"0 0 {:.1f} {:.1f}\" style=\"max-width:{:.0f}px\" role=\"img\" "
      "aria-label=\"Map {} from above\">\n{}</svg>\n<figcaption>{}</figcaption>\n<ul "
      "class=\"legend\">\n{}</ul>\n</figure>\n",
      width < kFullWidth ? " half" : "", view.width, view.height, view.width, group + 1, svg, caption, legend);
}

}  // namespace

std::string MapsSection(const ReportInput& input) {
  std::string pictures;
  std::size_t drawn = 0;
  for (std::size_t g = 0; g < input.result->groups.size() && drawn < kMostPictures; ++g, ++drawn) {
    const bool full = g == 0 || input.result->groups[g].size() > 1;
    pictures += GroupPicture(input, g, full ? kFullWidth : kHalfWidth);
  }
  if (pictures.empty()) return "";
  std::string more;
  if (drawn < input.result->groups.size()) {
    more = fmt::format("<p class=\"how\">{} more are not drawn here; their clouds are beside this report.</p>\n",
                       Plural(input.result->groups.size() - drawn, "map"));
  }
  return Section(
      "The merged map from above",
      "The cloud stands out more the higher and the denser it is; walls drawn twice side by side would be a bad "
      "merge. Lines are the drives, each from the dot beside its number. Wide bands mark where registration "
      "welded two drives together.",
      "<div class=\"maps\">\n" + pictures + "</div>\n" + more);
}

}  // namespace mapweld::report
