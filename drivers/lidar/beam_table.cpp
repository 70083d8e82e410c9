// SPDX-License-Identifier: Apache-2.0
#include "drivers/lidar/beam_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>
#include <utility>

namespace mapweld::lidar {
namespace {

constexpr std::string_view kBlank = " \t\r\n";

void SkipBlank(std::string_view* rest) {
  rest->remove_prefix(std::min(rest->find_first_not_of(kBlank), rest->size()));
}

bool TakeLiteral(std::string_view* rest, std::string_view literal) {
  SkipBlank(rest);
  if (!rest->starts_with(literal)) return false;
  rest->remove_prefix(literal.size());
  return true;
}

// A finite number of at most `limit` in size.
bool TakeNumber(std::string_view* rest, double limit, double* value) {
  SkipBlank(rest);
  const auto [end, error] = std::from_chars(rest->data(), rest->data() + rest->size(), *value);
  if (error != std::errc{} || !(std::abs(*value) <= limit)) return false;
  rest->remove_prefix(static_cast<std::size_t>(end - rest->data()));
  return true;
}

// Puts *rest behind `"key":`; false when the key is not there.
bool FindKey(std::string_view json, std::string_view key, std::string_view* rest) {
  for (std::size_t at = json.find(key); at != std::string_view::npos; at = json.find(key, at + 1)) {
    const std::size_t end = at + key.size();
    if (at == 0 || json[at - 1] != '"' || end >= json.size() || json[end] != '"') continue;
    *rest = json;
    rest->remove_prefix(end + 1);
    if (TakeLiteral(rest, ":")) return true;
  }
  return false;
}

bool ReadString(std::string_view json, std::string_view key, std::string_view* value) {
  std::string_view rest;
  if (!FindKey(json, key, &rest) || !TakeLiteral(&rest, "\"")) return false;
  const std::size_t end = rest.find('"');
  if (end == std::string_view::npos) return false;
  *value = rest.substr(0, end);
  return true;
}

// A flat list of numbers; the count is in *n.
bool ReadAngles(std::string_view json, std::string_view key, std::span<double> angles, std::size_t* n) {
  std::string_view rest;
  if (!FindKey(json, key, &rest) || !TakeLiteral(&rest, "[")) return false;
  for (*n = 0; *n < angles.size();) {
    if (!TakeNumber(&rest, 360.0, &angles[*n])) return false;
    ++*n;
    if (TakeLiteral(&rest, "]")) return true;
    if (!TakeLiteral(&rest, ",")) return false;
  }
  return false;
}

bool ReadColumns(std::string_view json, std::uint16_t* columns) {
  std::string_view mode;  // "1024x10"
  if (!ReadString(json, "lidar_mode", &mode)) return false;
  for (const auto& [name, value] :
       {std::pair<std::string_view, std::uint16_t>{"512x", 512}, {"1024x", 1024}, {"2048x", 2048}, {"4096x", 4096}}) {
    if (!mode.starts_with(name)) continue;
    *columns = value;
    return true;
  }
  return false;
}

Status ReadProfile(std::string_view json, OusterProfile* profile) {
  std::string_view name;
  *profile = OusterProfile::kLegacy;
  if (!ReadString(json, "udp_profile_lidar", &name) || name == "LEGACY") return Status::kOk;
  *profile = OusterProfile::kSingle;
  if (name == "RNG19_RFL8_SIG16_NIR16") return Status::kOk;
  *profile = OusterProfile::kLowRate;
  if (name == "RNG15_RFL8_NIR8") return Status::kOk;
  *profile = OusterProfile::kDual;
  return name == "RNG19_RFL8_SIG16_NIR16_DUAL" ? Status::kOk : Status::kVersion;
}

}  // namespace

std::array<std::uint16_t, BeamTable::kMaxBeams> RingsByElevation(const BeamTable& table) {
  std::array<std::uint16_t, BeamTable::kMaxBeams> rings{};
  const auto elevations = std::span(table.elevation_deg).first(table.beams);
  for (std::size_t beam = 0; beam < table.beams; ++beam) {
    rings[beam] = static_cast<std::uint16_t>(
        std::ranges::count_if(elevations, [&](double other) { return other < elevations[beam]; }));
  }
  return rings;
}

Status ParseHesaiAngles(std::string_view csv, std::size_t beams, BeamTable* table) {
  BeamTable parsed;
  std::array<bool, BeamTable::kMaxBeams> seen{};
  csv.remove_prefix(std::min(csv.find('\n'), csv.size()));  // the heading
  for (SkipBlank(&csv); !csv.empty(); SkipBlank(&csv)) {
    double channel = 0;
    double elevation = 0;
    double azimuth = 0;
    const bool whole = TakeNumber(&csv, static_cast<double>(beams), &channel) && TakeLiteral(&csv, ",") &&
                       TakeNumber(&csv, 90.0, &elevation) && TakeLiteral(&csv, ",") &&
                       TakeNumber(&csv, 360.0, &azimuth);
    if (!whole || channel < 1 || channel != std::floor(channel)) return Status::kBadInput;
    const auto beam = static_cast<std::size_t>(channel) - 1;
    if (seen[beam]) return Status::kBadInput;
    seen[beam] = true;
    parsed.elevation_deg[beam] = elevation;
    parsed.azimuth_deg[beam] = azimuth;
    ++parsed.beams;
  }
  if (parsed.beams != beams) return Status::kBadInput;
  *table = parsed;
  return Status::kOk;
}

Status ParseOusterMetadata(std::string_view json, OusterMetadata* metadata) {
  OusterMetadata parsed;
  std::size_t azimuths = 0;
  if (!ReadAngles(json, "beam_altitude_angles", parsed.beams.elevation_deg, &parsed.beams.beams) ||
      !ReadAngles(json, "beam_azimuth_angles", parsed.beams.azimuth_deg, &azimuths) || azimuths != parsed.beams.beams ||
      !ReadColumns(json, &parsed.columns_per_turn)) {
    return Status::kBadInput;
  }
  std::string_view rest;
  if (FindKey(json, "lidar_origin_to_beam_origin_mm", &rest) && !TakeNumber(&rest, 100.0, &parsed.origin_to_beam_mm)) {
    return Status::kBadInput;
  }
  if (const Status status = ReadProfile(json, &parsed.profile); status != Status::kOk) return status;
  *metadata = parsed;
  return Status::kOk;
}

}  // namespace mapweld::lidar
