// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/tools/report/fake_town.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mapweld::test {
namespace {

constexpr double kBlock_m = 70;  // from street to street
constexpr double kSpacing_m = 5;

// Streets follow a grid that is bent a little, so that nothing is exactly straight.
geom::Vec3d Street(double u, double v) {
  return {u + 12 * std::sin(v / 90), v + 10 * std::sin(u / 110), 2 * std::sin(u / 150) + v / 200};
}

// Small reproducible noise in [-1, 1] for one place.
double Noise(int a, int b, std::uint32_t seed) {
  std::uint32_t h = static_cast<std::uint32_t>(a) * 73856093U ^ static_cast<std::uint32_t>(b) * 19349663U ^ seed;
  for (int round = 0; round < 3; ++round) h = (h ^ (h >> 15U)) * 0x2C1B3C6DU;
  return static_cast<double>((h >> 8U) % 2001) / 1000.0 - 1.0;
}

// The town within 50 m of a keyframe, in the merged frame: walls along the blocks, roofs' edges, trees and road.
std::vector<geom::Vec3d> TownAround(double u0, double v0) {
  std::vector<geom::Vec3d> points;
  const int first_bu = static_cast<int>(std::floor((u0 - 50) / kBlock_m));
  const int first_bv = static_cast<int>(std::floor((v0 - 50) / kBlock_m));
  for (int bu = first_bu; bu <= first_bu + 2; ++bu) {
    for (int bv = first_bv; bv <= first_bv + 2; ++bv) {
      const double height = 6 + 5 * (Noise(bu, bv, 1) + 1);
      const double setback = 8 + 2 * Noise(bu, bv, 2);
      const double low_u = bu * kBlock_m + setback;
      const double low_v = bv * kBlock_m + setback;
      const double size = kBlock_m - 2 * setback;
      for (double s = 0; s < 4 * size; s += 1.0) {
        const double along = std::fmod(s, size);
        const int side = static_cast<int>(s / size);
        const double u = side == 0   ? low_u + along
                         : side == 1 ? low_u + size
                         : side == 2 ? low_u + size - along
                                     : low_u;
        const double v = side == 1   ? low_v + along
                         : side == 2 ? low_v + size
                         : side == 3 ? low_v + size - along
                                     : low_v;
        if (std::hypot(u - u0, v - v0) > 50 || std::fmod(along + 3 * side, 19) < 2) continue;  // gates between houses
        for (double z = 0; z < height; z += 2.0) points.push_back(Street(u, v) + geom::Vec3d(0, 0, z));
      }
    }
  }
  for (int i = -90; i <= 90; i += 6) {  // the road and its kerbs
    for (int j = -90; j <= 90; j += 6) {
      const double u = u0 + i * 0.5;
      const double v = v0 + j * 0.5;
      if (std::hypot(u - u0, v - v0) < 45) points.push_back(Street(u, v));
    }
  }
  return points;
}

struct Waypoint {
  double u = 0;
  double v = 0;
};

// A closed rectangle of streets for each drive; neighbours share a side.
Waypoint AlongRectangle(int drive, double path_m) {
  const double width = 3 * kBlock_m;
  const double depth = (2 + drive % 2) * kBlock_m;
  const double left = (drive % 3) * width;
  const double bottom = (drive / 3) * 3 * kBlock_m;
  double s = std::fmod(path_m, 2 * (width + depth));
  if (drive % 2 == 1) s = 2 * (width + depth) - s;  // every other drive goes clockwise
  if (s < width) return {left + s, bottom};
  s -= width;
  if (s < depth) return {left + width, bottom + s};
  s -= depth;
  if (s < width) return {left + width - s, bottom + depth};
  s -= width;
  return {left, bottom + depth - s};
}

}  // namespace

FakeTown::FakeTown(int drive_count, int keyframe_count) {
  for (int d = 0; d < drive_count; ++d) {
    merge::Drive drive;
    drive.name = fmt::format("2024-05-{:02}_car_{}", 3 + d, static_cast<char>('a' + d));
    std::vector<geom::Pose3> merged;
    std::vector<merge::SubmapCloud> clouds;
    // Each drive has an odometry frame of its own, turned about z and shifted.
    const geom::Pose3 merged_T_odom = {Street(AlongRectangle(d, 0).u, AlongRectangle(d, 0).v),
                                       geom::ExpSo3({0, 0, 0.7 * d})};
    for (int k = 0; k < keyframe_count; ++k) {
      const Waypoint here = AlongRectangle(d, k * kSpacing_m);
      const Waypoint next = AlongRectangle(d, k * kSpacing_m + 1);
      const geom::Vec3d p = Street(here.u, here.v);
      const geom::Vec3d ahead = Street(next.u, next.v) - p;
      const geom::Quatd q = geom::ExpSo3({0, 0, std::atan2(ahead.y(), ahead.x())}) * geom::ExpSo3({0.02, -0.01, 0});
      merged.push_back({p + geom::Vec3d(0, 0, 1.8), q});
      merge::Keyframe keyframe;
      keyframe.t = {1'714'700'000'000'000'000 + (d * 1000LL + k) * 600'000'000};
      keyframe.odom_T_body = merged_T_odom.Inverse() * merged.back();
      keyframe.path_m = k * kSpacing_m;
      drive.keyframes.push_back(keyframe);
      const geom::Pose3 level_T_merged = (merged_T_odom * geom::Level(keyframe.odom_T_body)).Inverse();
      merge::SubmapCloud cloud;
      for (const geom::Vec3d& point : TownAround(here.u, here.v)) {
        cloud.points.push_back((level_T_merged * point).cast<float>());
      }
      clouds.push_back(std::move(cloud));
    }
    drives.push_back(std::move(drive));
    result.merged_T_body.push_back(std::move(merged));
    submaps_.push_back(std::move(clouds));
  }

  // All but the last drive belong together.
  const int joined = std::max(1, drive_count - 1);
  result.groups.emplace_back();
  for (int d = 0; d < joined; ++d) result.groups[0].push_back(d);
  if (drive_count > joined) result.groups.push_back({drive_count - 1});
  for (int d = 0; d < drive_count; ++d) result.group_of.push_back(d < joined ? 0 : 1);

  for (int a = 0; a < drive_count; ++a) {
    for (int b = a + 1; b < drive_count; ++b) {
      merge::Overlap overlap;
      overlap.drive_a = a;
      overlap.drive_b = b;
      merge::DifferenceMatrix matrix{a, b, keyframe_count, keyframe_count, {}};
      for (int i = 0; i < keyframe_count; ++i) {
        for (int j = 0; j < keyframe_count; ++j) {
          const geom::Pose3& pose_a = result.merged_T_body[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)];
          const geom::Pose3& pose_b = result.merged_T_body[static_cast<std::size_t>(b)][static_cast<std::size_t>(j)];
          const double distance = (pose_a.t - pose_b.t).norm();
          const double value = 150 * (1 - std::exp(-distance / 20)) + 60 + 40 * Noise(i + 1000 * a, j + 1000 * b, 3);
          matrix.distance.push_back(static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0)));
          if (distance > 4) continue;
          overlap.matches.emplace_back(i, j);
          if ((i + j) % 3 == 0) {
            const geom::Pose3 a_T_b = geom::Level(pose_a).Inverse() * geom::Level(pose_b);
            overlap.loops.push_back({i, j, a_T_b, 0.71 + 0.1 * Noise(i, j, 4), 0.11 + 0.02 * Noise(i, j, 5), 0.97});
          }
        }
      }
      if (overlap.matches.size() < 2) continue;
      overlap.accepted = b < joined;
      overlap.test = overlap.accepted ? "registration" : "overlap ratio";
      if (!overlap.accepted) overlap.loops.clear();
      overlap.reverse = (a + b) % 2 == 0;
      overlap.length_m = kSpacing_m * static_cast<double>(overlap.matches.size());
      overlap.weight = overlap.accepted ? 0.5 + 0.4 * Noise(a, b, 6) : 0;
      overlap.a_T_b = {{10.0 * b, 5, 0}, geom::ExpSo3({0, 0, 0.7 * (b - a)})};
      result.overlaps.push_back(overlap);
      result.differences.push_back(std::move(matrix));
    }
  }
  result.times = {{"difference matrices", 0.42}, {"sequence matching", 1.31}, {"registration", 12.8},
                  {"pose graph", 2.05},          {"refinement", 6.4},         {"merged map", 1.9}};
}

std::shared_ptr<const merge::SubmapCloud> FakeTown::Find(merge::SubmapKey key) {
  return merge::Kept(&submaps_.at(static_cast<std::size_t>(key.drive)).at(static_cast<std::size_t>(key.keyframe)));
}

}  // namespace mapweld::test
