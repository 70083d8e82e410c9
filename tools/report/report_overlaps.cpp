// SPDX-License-Identifier: Apache-2.0
// Why drives were joined or not: the table of pairs and their difference matrices.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/report/html_text.hpp"
#include "tools/report/png_image.hpp"
#include "tools/report/report_parts.hpp"

namespace mapweld::report {
namespace {

constexpr std::size_t kMostRows = 200;
constexpr std::size_t kMostThumbnails = 24;
constexpr double kThumbnailWidth = 260;
constexpr int kMostPixels = 390;  // along one side of a thumbnail's picture

double Median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string Number(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "\xE2\x80\x93";
}

std::string OverlapRow(const ReportInput& input, const merge::Overlap& overlap) {
  std::vector<double> ratios;
  std::vector<double> residuals;
  for (const merge::Loop& loop : overlap.loops) {
    ratios.push_back(100 * loop.overlap_ratio);
    residuals.push_back(100 * loop.residual_m);
  }
  return fmt::format(
      "<tr><td class=\"pair\">{}</td><td class=\"pair\">{}</td><td class=\"{}\">{}</td><td>{}</td><td>{}</td><td "
      "class=\"n\">{}</td>"
      "<td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
      "<td class=\"n\">{}</td></tr>\n",
      DriveLabel(input, overlap.drive_a), DriveLabel(input, overlap.drive_b), overlap.accepted ? "yes" : "no",
      overlap.accepted ? "\xE2\x9C\x93 accepted" : "\xE2\x9C\x97 rejected", EscapeHtml(overlap.test),
      overlap.reverse ? "opposite" : "same", Count(overlap.matches.size()), Count(overlap.loops.size()),
      Number(overlap.length_m, 0), Number(Median(ratios), 0), Number(Median(residuals), 1), Number(overlap.weight, 2));
}

// Shrinks by keeping the smallest distance of each block, so that a thin diagonal survives, and stretches the contrast.
PaletteImage Thumbnail(const merge::DifferenceMatrix& matrix) {
  const int step = std::max(1, (std::max(matrix.rows, matrix.cols) + kMostPixels - 1) / kMostPixels);
  PaletteImage image;
  image.palette = GrayPalette();
  image.width = (matrix.cols + step - 1) / step;
  image.height = (matrix.rows + step - 1) / step;
  image.pixels.assign(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height), 255);
  for (int r = 0; r < matrix.rows; ++r) {
    for (int c = 0; c < matrix.cols; ++c) {
      const auto from =
          static_cast<std::size_t>(r) * static_cast<std::size_t>(matrix.cols) + static_cast<std::size_t>(c);
      auto& to = image.pixels[static_cast<std::size_t>(r / step) * static_cast<std::size_t>(image.width) +
                              static_cast<std::size_t>(c / step)];
      to = std::min(to, matrix.distance.at(from));
    }
  }
  std::vector<std::uint8_t> sorted = image.pixels;
  std::sort(sorted.begin(), sorted.end());
  const double low = sorted[sorted.size() / 200];
  const double high = std::max(low + 1.0, static_cast<double>(sorted[sorted.size() * 9 / 10]));
  for (std::uint8_t& pixel : image.pixels) {
    pixel = static_cast<std::uint8_t>(std::clamp(255 * (pixel - low) / (high - low), 0.0, 255.0));
  }
  return image;
}

std::string Card(const ReportInput& input, const merge::DifferenceMatrix& matrix, const merge::Overlap& overlap) {
  // Very long drives against short ones keep a shape that can be read.
  const double aspect = std::clamp(static_cast<double>(matrix.rows) / matrix.cols, 0.5, 1.2);
  const double height = kThumbnailWidth * aspect;
  std::string marks;
  const auto mark = [&](int row, int column, std::string_view look) {
    marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" {}/>", (column + 0.5) / matrix.cols * kThumbnailWidth,
                         (row + 0.5) / matrix.rows * height, look);
  };
  for (const auto& [a, b] : overlap.matches) mark(a, b, "r=\"2.6\" class=\"match\"");
  for (const merge::Loop& loop : overlap.loops) mark(loop.keyframe_a, loop.keyframe_b, "r=\"1.7\" class=\"loop\"");
  return fmt::format(
      "<figure class=\"card\">\n<svg viewBox=\"0 0 {0} {1:.1f}\" role=\"img\" aria-label=\"difference matrix\">"
      "<image href=\"{2}\" width=\"{0}\" height=\"{1:.1f}\" preserveAspectRatio=\"none\"/>{3}</svg>\n"
      "<figcaption><span>{4} down</span><span>{5} across</span></figcaption>\n</figure>\n",
      kThumbnailWidth, height, PngDataUri(Thumbnail(matrix)), marks, DriveLabel(input, overlap.drive_a),
      DriveLabel(input, overlap.drive_b));
}

}  // namespace

std::string OverlapsSection(const ReportInput& input) {
  std::vector<const merge::Overlap*> sorted;
  for (const merge::Overlap& overlap : input.result->overlaps) sorted.push_back(&overlap);
  std::stable_partition(sorted.begin(), sorted.end(), [](const merge::Overlap* o) { return o->accepted; });
  if (sorted.empty()) {
    return Section("Overlaps", "No two drives looked alike anywhere, so no pair was examined.", "");
  }
  std::string rows;
  for (std::size_t i = 0; i < sorted.size() && i < kMostRows; ++i) rows += OverlapRow(input, *sorted[i]);
  std::string table =
      "<div class=\"scroll\"><table>\n<tr><th colspan=\"2\">Pair</th><th>Verdict</th><th>Decided "
      "by</th><th>Direction</th>"
      "<th class=\"n\">Matches</th><th class=\"n\">Confirmed</th><th class=\"n\">Length m</th>"
      "<th class=\"n\">Overlap %</th><th class=\"n\">Residual cm</th><th class=\"n\">Weight</th></tr>\n" +
      rows + "</table></div>\n";
  if (sorted.size() > kMostRows) {
    table +=
        fmt::format("<p class=\"how\">{} more pairs are in overlaps.json.</p>\n", Count(sorted.size() - kMostRows));
  }
  return Section(
      "Overlaps",
      "Every pair of drives that looked alike somewhere. Matches were proposed by appearance, confirmed ones "
      "stood up to registration; overlap and residual are their medians. Two drives are joined only by an "
      "accepted pair.",
      table);
}

std::string DifferencesSection(const ReportInput& input) {
  std::string cards;
  std::size_t shown = 0;
  std::size_t hidden = 0;
  for (const merge::DifferenceMatrix& matrix : input.result->differences) {
    const auto overlap =
        std::find_if(input.result->overlaps.begin(), input.result->overlaps.end(), [&](const merge::Overlap& o) {
          return o.accepted && o.drive_a == matrix.drive_a && o.drive_b == matrix.drive_b;
        });
    if (overlap == input.result->overlaps.end() || matrix.rows <= 0 || matrix.cols <= 0) continue;
    if (shown == kMostThumbnails) {
      ++hidden;
      continue;
    }
    cards += Card(input, matrix, *overlap);
    ++shown;
  }
  if (cards.empty()) return "";
  std::string html = "<div class=\"cards\">\n" + cards + "</div>\n";
  if (hidden > 0) html += fmt::format("<p class=\"how\">{} not shown.</p>\n", Plural(hidden, "more pair"));
  return Section("Where the drives look alike",
                 "Each pixel compares one keyframe of either drive: dark is alike. A street driven twice is a dark "
                 "diagonal, falling for the same direction, rising for the opposite one. Rings are matches that were "
                 "proposed, dots those that registration confirmed.",
                 html);
}

}  // namespace mapweld::report
