// SPDX-License-Identifier: Apache-2.0
#include "tools/report/report.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "tools/io/atomic_file.hpp"
#include "tools/report/html_text.hpp"
#include "tools/report/palette.hpp"
#include "tools/report/report_parts.hpp"

namespace mapweld::report {

std::string Section(std::string_view heading, std::string_view how, std::string_view body) {
  return fmt::format("<section>\n<h2>{}</h2>\n<p class=\"how\">{}</p>\n{}</section>\n", heading, how, body);
}

std::string DriveBadge(int drive) {
  return fmt::format("<span class=\"tag\" style=\"background:{}\">{}</span>", DriveColorHex(drive), drive + 1);
}

std::string DriveLabel(const ReportInput& input, int drive) {
  const std::string name = EscapeHtml(input.drives->at(static_cast<std::size_t>(drive)).name);
  return fmt::format("<span class=\"label\" title=\"{0}\">{1}{0}</span>", name, DriveBadge(drive));
}

double DriveLength(const merge::Drive& drive) {
  return drive.keyframes.empty() ? 0 : drive.keyframes.back().path_m;
}

std::size_t KeyframeCount(const ReportInput& input, const std::vector<int>& group) {
  std::size_t count = 0;
  for (const int drive : group) count += input.drives->at(static_cast<std::size_t>(drive)).keyframes.size();
  return count;
}

std::string ReportHtml(const ReportInput& input) {
  if (input.drives == nullptr || input.result == nullptr || input.maps == nullptr) {
    throw std::runtime_error("the report needs drives, a merge result and maps");
  }
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n<style>{}</style>\n"
      "</head>\n<body>\n<main>\n",
      EscapeHtml(input.title), ReportStyle());
  html += SummarySection(input) + MapsSection(input) + OverlapsSection(input) + DifferencesSection(input) +
          GroupsSection(input) + DrivesSection(input) + TimesSection(input);
  html += fmt::format("<footer>Made by Mapweld.{}{}</footer>\n</main>\n</body>\n</html>\n",
                      input.footnote.empty() ? "" : " ", EscapeHtml(input.footnote));
  return html;
}

void WriteReport(const std::filesystem::path& html, const ReportInput& input) {
  io::WriteFileAtomically(html, ReportHtml(input));
}

}  // namespace mapweld::report
