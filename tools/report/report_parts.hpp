// SPDX-License-Identifier: Apache-2.0
// The sections of the report, each a piece of HTML. Empty text where there is nothing to show.
#pragma once

#include <string>
#include <string_view>

#include "tools/report/report.hpp"

namespace mapweld::report {

std::string SummarySection(const ReportInput& input);      // verdict and tiles
std::string MapsSection(const ReportInput& input);         // one picture per group
std::string OverlapsSection(const ReportInput& input);     // table of pairs
std::string DifferencesSection(const ReportInput& input);  // thumbnails of the difference matrices
std::string GroupsSection(const ReportInput& input);       // table of groups
std::string DrivesSection(const ReportInput& input);       // table of drives
std::string TimesSection(const ReportInput& input);        // bar chart of stage times
std::string_view ReportStyle();                            // CSS

// Opens a section with a heading and the line that says how to read it; `body` follows.
std::string Section(std::string_view heading, std::string_view how, std::string_view body);
// The number of a drive in its colour, as on the map, optionally with its name.
std::string DriveBadge(int drive);
std::string DriveLabel(const ReportInput& input, int drive);

double DriveLength(const merge::Drive& drive);
std::size_t KeyframeCount(const ReportInput& input, const std::vector<int>& group);

}  // namespace mapweld::report
