// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/path_town.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "tools/sim/hash_noise.hpp"
#include "tools/sim/house_clearance.hpp"

namespace mapweld::sim {
namespace {

constexpr double kHalfWidth_m = 4;
constexpr double kApart_m = 3000;

Polyline ReadPath(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) {
    throw std::runtime_error(fmt::format(
        "{} is not there: this scenario drives real paths, of the KITTI odometry benchmark or the NCLT data set, which "
        "are not part of the program; put the ground truth (KITTI: poses/*.txt, NCLT: as TUM) into that folder",
        file.string()));
  }
  Polyline path;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.starts_with('#')) continue;
    std::istringstream row(line);
    const std::vector<double> pose{std::istream_iterator<double>(row), {}};
    const bool is_kitti = pose.size() == 12;
    if (!row.eof() || (!is_kitti && pose.size() != 8)) {
      throw std::runtime_error(
          fmt::format("{}, row {}: neither twelve numbers (KITTI) nor eight (TUM)", file.string(), number));
    }
    const Vec2d p = is_kitti ? Vec2d(pose[3], pose[11]) : Vec2d(pose[1], pose[2]);
    if (path.empty() || (p - path.back()).norm() > 0.3) path.push_back(p);
  }
  if (path.size() < 2 || Length(path) < 100) {
    throw std::runtime_error(fmt::format("{} holds no path of at least 100 m", file.string()));
  }
  return path;
}

}  // namespace

PathTown BuildPathTown(const PathPlan& plan, std::uint64_t seed) {
  constexpr double kNode_m = 4;
  constexpr double kRow_m = 90;
  PathTown result;
  std::int64_t next_id = 10'000'000;
  std::int64_t next_node = 1;
  for (std::size_t n = 0; n < plan.names.size(); ++n) {
    Polyline path = Resample(ReadPath(plan.folder / (plan.names[n] + ".txt")), kNode_m);
    if (!plan.one_frame) {
      const Vec2d shift = Vec2d(static_cast<double>(n % 4), static_cast<double>(n / 4)) * kApart_m - path.front();
      for (Vec2d& p : path) p += shift;
    }
    Road road{static_cast<std::int64_t>(n) + 1, {}, path, kHalfWidth_m, true, true};
    for (std::size_t i = 0; i < path.size(); ++i) road.nodes.push_back(next_node++);
    for (const Vec2d& p : path) result.town.bounds.Extend(p);
    const TownStyle& style = StyleByName(Uniform(Hash(seed, 1, n)) < 0.5 ? "suburb" : "old_town");
    const auto row = static_cast<std::size_t>(kRow_m / kNode_m);
    for (std::size_t i = 0; i + row < path.size(); i += row) {
      Polyline line(path.begin() + static_cast<std::ptrdiff_t>(i),
                    path.begin() + static_cast<std::ptrdiff_t>(i + row + 1));
      AddRowOfHouses(line, kHalfWidth_m, 0, style, Hash(seed, 2 + n, i), &next_id, &result.town);
      std::reverse(line.begin(), line.end());
      AddRowOfHouses(line, kHalfWidth_m, 0, style, Hash(seed, 3 + n, i), &next_id, &result.town);
    }
    StreetPath street;
    for (std::size_t i = 0; i < path.size(); ++i) street.nodes.push_back(static_cast<std::uint32_t>(road.nodes[i]));
    street.centreline = path;
    result.drives.push_back({plan.one_frame ? 0 : static_cast<int>(n), std::move(street)});
    result.town.roads.push_back(std::move(road));
  }
  MoveHousesOffStreets(result.town);
  RemoveWhatBlocksStreets(&result.town);
  return result;
}

}  // namespace mapweld::sim
