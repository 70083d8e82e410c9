// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace mapweld::sim {
namespace {

using nlohmann::json;

class Fields {
 public:
  Fields(const json& object, std::string where, std::initializer_list<const char*> known)
      : object_(object), where_(std::move(where)) {
    if (!object.is_object()) throw std::runtime_error(fmt::format("{}: expected an object in braces", where_));
    for (const auto& item : object.items()) {
      if (std::find(known.begin(), known.end(), item.key()) == known.end()) {
        throw std::runtime_error(
            fmt::format("{}: unknown key '{}'; known are {}", where_, item.key(), fmt::join(known, ", ")));
      }
    }
  }
  template <typename T>
  [[nodiscard]] T Get(const char* key) const {
    const auto found = object_.find(key);
    if (found == object_.end()) throw std::runtime_error(fmt::format("{}: key '{}' is missing", where_, key));
    try {
      return found->get<T>();
    } catch (const json::exception& e) {
      throw std::runtime_error(fmt::format("{}: key '{}' has the wrong kind of value ({})", where_, key, e.what()));
    }
  }
  [[nodiscard]] bool Has(const char* key) const { return object_.contains(key); }
  [[nodiscard]] GeoPoint Point(const std::array<double, 2>& lat_lon) const {
    if (!(std::abs(lat_lon[0]) <= 85) || !(std::abs(lat_lon[1]) <= 180)) {
      throw std::runtime_error(
          fmt::format("{}: ({}, {}) is no [latitude, longitude] in degrees", where_, lat_lon[0], lat_lon[1]));
    }
    return {lat_lon[0], lat_lon[1]};
  }

 private:
  const json& object_;
  std::string where_;
};

VehiclePlan ReadVehicle(const json& object, const std::string& where) {
  const Fields fields(object, where, {"id", "about", "route"});
  VehiclePlan plan;
  plan.id = fields.Get<int>("id");
  if (plan.id < 1 || plan.id > 32767) {
    throw std::runtime_error(fmt::format("{}: id {} is outside 1..32767", where, plan.id));
  }
  for (const auto& point : fields.Get<std::vector<std::array<double, 2>>>("route")) {
    plan.waypoints.push_back(fields.Point(point));
  }
  return plan;
}

SurveyPlan ReadSurvey(const json& object, const std::string& where) {
  const Fields fields(
      object, where,
      {"drives", "runs", "straight_on", "zones", "zone_radius_m", "min_length_m", "max_length_m", "total_length_m"});
  SurveyPlan plan;
  plan.drives = fields.Get<int>("drives");
  if (fields.Has("runs")) plan.runs = fields.Get<int>("runs");
  if (fields.Has("straight_on")) plan.straight_on = fields.Get<bool>("straight_on");
  plan.zones = fields.Get<int>("zones");
  plan.zone_radius_m = fields.Get<double>("zone_radius_m");
  plan.min_length_m = fields.Get<double>("min_length_m");
  plan.max_length_m = fields.Get<double>("max_length_m");
  plan.total_length_m = fields.Get<double>("total_length_m");
  if (plan.drives < 1 || plan.drives > 32767 || plan.zones < 1 || plan.zones > plan.drives) {
    throw std::runtime_error(fmt::format("{}: needs 1 to 32767 drives and at most as many zones", where));
  }
  if (plan.runs < 1 || plan.drives % plan.runs != 0) {
    throw std::runtime_error(
        fmt::format("{}: {} drives are no whole number of routes of {} runs", where, plan.drives, plan.runs));
  }
  if (!(plan.zone_radius_m > 0) || !(plan.min_length_m >= 100) || !(plan.max_length_m >= plan.min_length_m) ||
      !(plan.total_length_m >= plan.min_length_m * plan.drives) ||
      !(plan.total_length_m <= plan.max_length_m * plan.drives)) {
    throw std::runtime_error(
        fmt::format("{}: needs a radius, drives of at least 100 m, and a total that they can reach", where));
  }
  return plan;
}

TownPlan ReadTownPlan(const json& object, const std::string& where) {
  const Fields fields(object, where, {"style", "size_m", "seed", "cellar_m"});
  TownPlan plan;
  plan.style = fields.Get<std::string>("style");
  plan.size_m = fields.Get<double>("size_m");
  plan.seed = fields.Get<std::uint64_t>("seed");
  if (!(plan.size_m >= 300) || !(plan.size_m <= 10000)) {
    throw std::runtime_error(fmt::format("{}: size_m {} is outside 300..10000", where, plan.size_m));
  }
  if (fields.Has("cellar_m")) plan.cellar_m = fields.Get<double>("cellar_m");
  if (plan.cellar_m != 0 && (!(plan.cellar_m >= 3.3) || !(plan.cellar_m <= 4.5))) {
    throw std::runtime_error(fmt::format("{}: cellar_m {} is neither 0 nor in 3.3..4.5", where, plan.cellar_m));
  }
  const TownStyle& style = StyleByName(plan.style);
  if (plan.cellar_m != 0 && (style.bend_m != 0 || style.swirl_m != 0 || style.highways)) {
    throw std::runtime_error(fmt::format(
        "{}: streets of the style {} are not straight enough for a cellar; plaza's are", where, plan.style));
  }
  return plan;
}

PathPlan ReadPathPlan(const json& object, const std::filesystem::path& beside, const std::string& where) {
  const Fields fields(object, where, {"folder", "names", "one_frame"});
  PathPlan plan;
  if (fields.Has("one_frame")) plan.one_frame = fields.Get<bool>("one_frame");
  plan.folder = beside / fields.Get<std::string>("folder");
  plan.names = fields.Get<std::vector<std::string>>("names");
  if (plan.names.empty()) throw std::runtime_error(fmt::format("{}: 'names' is empty", where));
  return plan;
}

// Installed: <prefix>/bin/mapweld and <prefix>/share/mapweld/sim. In the build tree: the source folder.
std::filesystem::path ScenarioFolder() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    const auto installed = program.parent_path().parent_path() / "share/mapweld/sim";
    if (std::filesystem::exists(installed, error)) return installed;
  }
  return MAPWELD_SIM_DATA_DIR;
}

}  // namespace

std::vector<int> VehicleIds(const Scenario& scenario) {
  std::vector<int> ids;
  for (const VehiclePlan& plan : scenario.vehicles) ids.push_back(plan.id);
  if (scenario.survey) {
    for (int id = 1; id <= scenario.survey->drives; ++id) ids.push_back(id);
  }
  if (scenario.paths) {
    for (int id = 1; id <= static_cast<int>(scenario.paths->names.size()); ++id) ids.push_back(id);
  }
  return ids;
}

Scenario ReadScenario(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(fmt::format("cannot open scenario {}", file.string()));
  json document;
  try {
    document = json::parse(stream);
  } catch (const json::exception& e) {
    throw std::runtime_error(fmt::format("scenario {} is no valid JSON: {}", file.string(), e.what()));
  }
  const std::string where = "scenario " + file.string();
  const Fields fields(document, where,
                      {"name", "about", "town", "origin", "seed", "relief_m", "traffic", "max_speed_mps", "rain_share",
                       "vehicles", "survey", "paths"});
  Scenario scenario;
  scenario.name = fields.Get<std::string>("name");
  if (fields.Has("paths")) {
    scenario.town = TownPlan{};
  } else if (document.contains("town") && document["town"].is_object()) {
    scenario.town = ReadTownPlan(document["town"], where + ", town");
  } else {
    scenario.town = file.parent_path() / fields.Get<std::string>("town");
    scenario.origin = fields.Point(fields.Get<std::array<double, 2>>("origin"));
  }
  if (fields.Has("seed")) scenario.seed = fields.Get<std::uint64_t>("seed");
  if (fields.Has("relief_m")) scenario.relief_m = fields.Get<double>("relief_m");
  if (fields.Has("traffic")) scenario.traffic = fields.Get<double>("traffic");
  if (fields.Has("rain_share")) scenario.rain_share = fields.Get<double>("rain_share");
  if (!(scenario.rain_share >= 0) || !(scenario.rain_share <= 1)) {
    throw std::runtime_error(fmt::format("{}: rain_share must be in 0..1", where));
  }
  if (!(scenario.relief_m >= 0) || !(scenario.relief_m <= 20) || !(scenario.traffic >= 0) || !(scenario.traffic <= 3)) {
    throw std::runtime_error(fmt::format("{}: relief_m must be in 0..20 and traffic in 0..3", where));
  }
  if (fields.Has("max_speed_mps")) scenario.max_speed_mps = fields.Get<double>("max_speed_mps");
  if (!(scenario.max_speed_mps >= 1) || !(scenario.max_speed_mps <= 50)) {
    throw std::runtime_error(fmt::format("{}: max_speed_mps must be in 1..50", where));
  }
  if ((fields.Has("survey") ? 1 : 0) + (fields.Has("vehicles") ? 1 : 0) + (fields.Has("paths") ? 1 : 0) != 1) {
    throw std::runtime_error(fmt::format("{}: needs either 'vehicles', 'survey' or 'paths'", where));
  }
  if (fields.Has("paths")) {
    scenario.paths = ReadPathPlan(fields.Get<json>("paths"), file.parent_path(), where + ", paths");
    return scenario;
  }
  if (fields.Has("survey")) {
    scenario.survey = ReadSurvey(fields.Get<json>("survey"), where + ", survey");
    return scenario;
  }
  const auto vehicles = fields.Get<std::vector<json>>("vehicles");
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    scenario.vehicles.push_back(ReadVehicle(vehicles[i], fmt::format("{}, vehicle number {}", where, i + 1)));
  }
  if (scenario.vehicles.empty()) throw std::runtime_error(fmt::format("{}: 'vehicles' is empty", where));
  std::sort(scenario.vehicles.begin(), scenario.vehicles.end(),
            [](const VehiclePlan& a, const VehiclePlan& b) { return a.id < b.id; });
  for (std::size_t i = 1; i < scenario.vehicles.size(); ++i) {
    if (scenario.vehicles[i].id == scenario.vehicles[i - 1].id) {
      throw std::runtime_error(fmt::format("{}: two vehicles have id {}", where, scenario.vehicles[i].id));
    }
  }
  return scenario;
}

std::filesystem::path ScenarioByName(const std::string& name) {
  const std::filesystem::path folder = ScenarioFolder();
  std::filesystem::path file = folder / (name + ".json");
  if (std::filesystem::exists(file)) return file;
  std::vector<std::string> known;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    // A CityJSON town is NAME.city.json.
    const std::filesystem::path file_name = entry.path().filename();
    if (file_name.extension() == ".json" && !file_name.stem().has_extension()) known.push_back(file_name.stem());
  }
  std::sort(known.begin(), known.end());
  throw std::runtime_error(
      fmt::format("there is no scenario '{}'; give one of {} or a .json file", name, fmt::join(known, ", ")));
}

}  // namespace mapweld::sim
