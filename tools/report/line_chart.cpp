// SPDX-License-Identifier: Apache-2.0
#include "tools/report/line_chart.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "tools/io/atomic_file.hpp"
#include "tools/report/html_text.hpp"
#include "tools/report/palette.hpp"

extern char** environ;

namespace mapweld::report {
namespace {

constexpr double kPlotWidth = 300;
constexpr double kPlotHeight = 240;
constexpr double kLeft = 54;
constexpr double kTop = 34;
constexpr double kBottom = 46;
constexpr double kGap = 20;
constexpr double kKeyEntry = 150;
constexpr double kKeyLine = 20;
constexpr double kLineWidth = 2;

// Pixels per unit of the picture: sharp on any screen.
constexpr const char* kPngZoom = "2";

class Canvas {
 public:
  template <class... Args>
  void Add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(svg_), format, std::forward<Args>(args)...);
  }
  void Text(double x, double y, std::string_view anchor, std::string_view extra, std::string_view text) {
    Add("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, extra, EscapeHtml(text));
  }
  std::string Take() { return std::move(svg_); }

 private:
  std::string svg_;
};

double ToX(const Axis& axis, double value) {
  return kLeft + kPlotWidth * (std::clamp(value, axis.from, axis.to) - axis.from) / (axis.to - axis.from);
}

double ToY(const Axis& axis, double value) {
  return kTop + kPlotHeight * (axis.to - std::clamp(value, axis.from, axis.to)) / (axis.to - axis.from);
}

std::vector<double> Ticks(const Axis& axis) {
  std::vector<double> ticks;
  const int count = static_cast<int>(std::floor((axis.to - axis.from) / axis.tick + 1e-6));
  for (int i = 0; i <= count; ++i) ticks.push_back(axis.from + i * axis.tick);
  return ticks;
}

void DrawAxes(const LineChart& chart, Canvas* canvas) {
  for (const double tick : Ticks(chart.x)) {
    const double x = ToX(chart.x, tick);
    canvas->Add("<path class=\"grid\" d=\"M{0:.1f} {1}v{2}\"/>\n", x, kTop, kPlotHeight);
    canvas->Text(x, kTop + kPlotHeight + 16, "middle", "", fmt::format("{:.4g}", tick));
  }
  for (const double tick : Ticks(chart.y)) {
    const double y = ToY(chart.y, tick);
    canvas->Add("<path class=\"grid\" d=\"M{0} {1:.1f}h{2}\"/>\n", kLeft, y, kPlotWidth);
    canvas->Text(kLeft - 6, y + 4, "end", "", fmt::format("{:.4g}", tick));
  }
  canvas->Add("<path class=\"axis\" d=\"M{} {}v{}h{}\"/>\n", kLeft, kTop, kPlotHeight, kPlotWidth);
  canvas->Text(kLeft, kTop - 14, "start", " class=\"title\"", chart.title);
  canvas->Text(kLeft + kPlotWidth / 2, kTop + kPlotHeight + 36, "middle", "", chart.x.label);
  const double middle = kTop + kPlotHeight / 2;
  canvas->Text(14, middle, "middle", fmt::format(" transform=\"rotate(-90 14 {})\"", middle), chart.y.label);
}

std::string Stroke(int series) {
  const std::string dashes = DriveDashes(series, kLineWidth);
  return fmt::format("stroke=\"{}\" stroke-width=\"{}\"{}", DriveColorHex(series), kLineWidth,
                     dashes.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", dashes));
}

void DrawSeries(const LineChart& chart, Canvas* canvas) {
  for (std::size_t s = 0; s < chart.series.size(); ++s) {
    const int color = static_cast<int>(s);
    std::string line;
    for (const auto& [x, y] : chart.series[s].points) {
      fmt::format_to(std::back_inserter(line), "{:.1f},{:.1f} ", ToX(chart.x, x), ToY(chart.y, y));
    }
    canvas->Add("<polyline fill=\"none\" stroke-linejoin=\"round\" {} points=\"{}\"/>\n", Stroke(color), line);
    if (!chart.marks) continue;
    for (const auto& [x, y] : chart.series[s].points) {
      canvas->Add("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", ToX(chart.x, x), ToY(chart.y, y),
                  DriveColorHex(color));
    }
  }
}

}  // namespace

std::string ChartsSvg(const std::vector<LineChart>& charts) {
  if (charts.empty()) throw std::runtime_error("there is no chart to draw");
  const double step = kLeft + kPlotWidth + kGap;
  const double width = step * static_cast<double>(charts.size());
  const std::vector<Series>& key = charts.front().series;
  const auto per_line = static_cast<std::size_t>(std::max(1.0, std::floor((width - kLeft) / kKeyEntry)));
  const std::size_t key_lines = (key.size() + per_line - 1) / per_line;
  const double key_top = kTop + kPlotHeight + kBottom + kKeyLine;
  const double height = key_top + kKeyLine * static_cast<double>(key_lines);
  Canvas canvas;
  canvas.Add(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n"
      "<style>.grid{{stroke:#ddd}}.axis{{stroke:#444;fill:none}}.title{{font-size:14px;font-weight:bold}}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
      width, height);
  for (std::size_t c = 0; c < charts.size(); ++c) {
    canvas.Add("<g transform=\"translate({:.0f} 0)\">\n", step * static_cast<double>(c));
    DrawAxes(charts[c], &canvas);
    DrawSeries(charts[c], &canvas);
    canvas.Add("</g>\n");
  }
  for (std::size_t s = 0; s < key.size(); ++s) {
    const double x = kLeft + kKeyEntry * static_cast<double>(s % per_line);
    const double y = key_top + kKeyLine * static_cast<double>(s / per_line);
    canvas.Add("<path fill=\"none\" {} d=\"M{:.1f} {:.1f}h24\"/>\n", Stroke(static_cast<int>(s)), x, y - 4);
    canvas.Text(x + 30, y, "start", "", key[s].name);
  }
  canvas.Add("</svg>\n");
  return canvas.Take();
}

std::string WriteCharts(const std::filesystem::path& without_extension, const std::vector<LineChart>& charts) {
  const std::string svg = without_extension.string() + ".svg";
  const std::string png = without_extension.string() + ".png";
  if (without_extension.has_parent_path()) std::filesystem::create_directories(without_extension.parent_path());
  io::WriteFileAtomically(svg, ChartsSvg(charts));
  std::array<std::string, 6> words = {"rsvg-convert", "-z", kPngZoom, "-o", png, svg};
  std::array<char*, 7> arguments{};
  std::transform(words.begin(), words.end(), arguments.begin(), [](std::string& word) { return word.data(); });
  pid_t child = 0;
  int status = -1;
  const bool ran = posix_spawnp(&child, words[0].c_str(), nullptr, nullptr, arguments.data(), environ) == 0 &&
                   waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
  return ran ? "" : fmt::format("{} is not written; it needs rsvg-convert (Debian package librsvg2-bin)", png);
}

}  // namespace mapweld::report
