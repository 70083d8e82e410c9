// SPDX-License-Identifier: Apache-2.0
#include "tools/report/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace mapweld::report {
namespace {

using Json = nlohmann::ordered_json;
using Field = std::optional<double> DriveSummary::*;

Json OrNull(const std::optional<double>& value) {
  return value.has_value() ? Json(*value) : Json(nullptr);
}

// Per drive and over all drives, divided by the kilometres driven.
Json PerKm(const Summary& summary, Field field) {
  Json out = Json::object();
  double bytes = 0;
  double km = 0;
  for (const DriveSummary& drive : summary.drives) {
    const auto& value = drive.*field;
    if (!value.has_value() || drive.path_m <= 0) continue;
    out[drive.name] = *value / (drive.path_m * 1e-3);
    bytes += *value;
    km += drive.path_m * 1e-3;
  }
  out["all"] = km > 0 ? Json(bytes / km) : Json(nullptr);
  return out;
}

Json HeapCalls(const Summary& summary) {
  std::int64_t calls = 0;
  bool known = false;
  for (const DriveSummary& drive : summary.drives) {
    if (!drive.heap_calls.has_value()) continue;
    if (*drive.heap_calls < 0) return nullptr;  // one agent does not watch its allocator
    calls += *drive.heap_calls;
    known = true;
  }
  return known ? Json(calls) : Json(nullptr);
}

std::string Cell(const std::optional<double>& value, const char* format) {
  return value.has_value() ? fmt::format(fmt::runtime(format), *value) : "-";
}

std::string GroupLines(const Summary& summary) {
  std::string out;
  for (std::size_t g = 0; g < summary.group_rmse_m.size(); ++g) {
    if (!summary.group_rmse_m[g].has_value()) continue;
    int drives = 0;
    double path_m = 0;
    for (const DriveSummary& drive : summary.drives) {
      if (drive.group != static_cast<int>(g) + 1) continue;
      ++drives;
      path_m += drive.path_m;
    }
    if (drives < 2) continue;
    const double rmse_m = *summary.group_rmse_m[g];
    out += fmt::format("group {}: {} drives, {:.2f} km, rmse {:.3f} m, {:.4f} % of its length\n", g + 1, drives,
                       path_m / 1000, rmse_m, 100 * rmse_m / path_m);
  }
  return out;
}

}  // namespace

std::string SummaryJson(const Summary& summary) {
  Json json;
  json["groups"] = summary.groups;
  Json rmse = Json::object();
  Json drives = Json::object();
  for (const DriveSummary& drive : summary.drives) {
    rmse[drive.name] = OrNull(drive.rmse_m);
    drives[drive.name] = {{"group", drive.group}, {"path_m", drive.path_m}, {"keyframes", drive.keyframes}};
  }
  rmse["all"] = OrNull(summary.rmse_all_m);
  json["rmse_m"] = rmse;
  Json group_rmse = Json::array();
  for (const std::optional<double>& of_group : summary.group_rmse_m) group_rmse.push_back(OrNull(of_group));
  json["group_rmse_m"] = group_rmse;
  json["bytes_per_km"] = PerKm(summary, &DriveSummary::bytes_sent);
  json["keyframe_bytes_per_km"] = PerKm(summary, &DriveSummary::keyframe_bytes);
  json["submap_bytes_per_km"] = PerKm(summary, &DriveSummary::submap_bytes);
  json["heap_calls_after_boot"] = HeapCalls(summary);
  json["overlaps"] = {{"accepted", summary.overlaps_accepted}, {"rejected", summary.overlaps_rejected}};
  Json seconds = Json::object();
  for (const merge::StageTime& time : summary.seconds) seconds[time.stage] = time.seconds;
  json["seconds"] = seconds;
  json["drives"] = drives;
  return json.dump(2) + "\n";
}

std::string SummaryTable(const Summary& summary) {
  std::size_t width = 5;
  for (const DriveSummary& drive : summary.drives) width = std::max(width, drive.name.size());
  std::string out =
      fmt::format("{:<{}}  group  length m  keyframes  rmse m  kB/km  kB/km keyframes  heap calls\n", "drive", width);
  for (const DriveSummary& drive : summary.drives) {
    const auto per_km = [&](const std::optional<double>& bytes) {
      return bytes.has_value() && drive.path_m > 0 ? std::optional(*bytes / drive.path_m) : std::nullopt;
    };
    out += fmt::format("{:<{}}  {:>5}  {:>8.0f}  {:>9}  {:>6}  {:>5}  {:>15}  {:>10}\n", drive.name, width, drive.group,
                       drive.path_m, drive.keyframes, Cell(drive.rmse_m, "{:.3f}"),
                       Cell(per_km(drive.bytes_sent), "{:.0f}"), Cell(per_km(drive.keyframe_bytes), "{:.0f}"),
                       drive.heap_calls.has_value() ? std::to_string(*drive.heap_calls) : "-");
  }
  if (summary.groups > 1) out += GroupLines(summary);
  out += fmt::format("{} drives in {} group{}; {} overlaps accepted, {} rejected; rmse over all {} m\n",
                     summary.drives.size(), summary.groups, summary.groups == 1 ? "" : "s", summary.overlaps_accepted,
                     summary.overlaps_rejected, Cell(summary.rmse_all_m, "{:.3f}"));
  std::string stages;
  for (const merge::StageTime& time : summary.seconds) {
    stages += fmt::format("{}{} {:.1f}", stages.empty() ? "" : ", ", time.stage, time.seconds);
  }
  if (!stages.empty()) out += "seconds: " + stages + "\n";
  return out;
}

}  // namespace mapweld::report
