// SPDX-License-Identifier: Apache-2.0
// A town of boxes for the merge tests: houses of random size along streets, and recordings of drives through it.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tools/merge/recording.hpp"

namespace mapweld::merge {

class SyntheticTown {
 public:
  explicit SyntheticTown(unsigned seed) : random_(seed) {}

  // Houses on both sides of a street of this length that starts at `from` and runs along +x.
  void AddStreet(const Eigen::Vector2f& from, float length_m) {
    for (const float side : {-1.0F, 1.0F}) {
      for (float x = Between(0, 6); x < length_m;) {
        const float width = Between(6, 16);
        const float depth = Between(5, 12);
        const float setback = Between(6, 12);
        AddBox({from.x() + x + width / 2, from.y() + side * (setback + depth / 2)}, {width, depth}, Between(3, 9));
        x += width + Between(1, 9);
      }
      for (float x = Between(0, 10); x < length_m; x += Between(7, 25)) {
        AddBox({from.x() + x, from.y() + side * Between(3.5F, 5)}, {0.5F, 0.5F}, Between(2, 5));  // poles and trees
      }
    }
  }
  void AddBox(const Eigen::Vector2f& center, const Eigen::Vector2f& size, float height) {
    constexpr float kStep = 0.45F;
    for (float z = 0.1F; z < height; z += kStep) {
      for (float x = -size.x() / 2; x <= size.x() / 2; x += kStep) {
        for (const float y : {-size.y() / 2, size.y() / 2}) points_.emplace_back(center.x() + x, center.y() + y, z);
      }
      for (float y = -size.y() / 2; y <= size.y() / 2; y += kStep) {
        for (const float x : {-size.x() / 2, size.x() / 2}) points_.emplace_back(center.x() + x, center.y() + y, z);
      }
    }
  }
  // The same structures once more, elsewhere: those within radius_m of `from`, moved by `shift`.
  void Copy(const Eigen::Vector2f& from, float radius_m, const Eigen::Vector2f& shift) {
    std::vector<Eigen::Vector3f> copies;
    for (const Eigen::Vector3f& p : points_) {
      if ((p.head<2>() - from).norm() < radius_m) copies.push_back(p + Eigen::Vector3f(shift.x(), shift.y(), 0));
    }
    points_.insert(points_.end(), copies.begin(), copies.end());
  }

  // What a lidar 1.8 m above the ground sees within range_m, in its own frame: all structures and the ground.
  [[nodiscard]] std::vector<Eigen::Vector3f> Scan(const geom::Pose3& world_T_lidar, unsigned seed,
                                                  float range_m = 30) const {
    std::mt19937 random(seed);
    const auto noise = [&] { return 0.04F * (static_cast<float>(random() % 1000) / 500.0F - 1); };
    const geom::Pose3 lidar_T_world = world_T_lidar.Inverse();
    const Eigen::Vector2f here = world_T_lidar.t.head<2>().cast<float>();
    std::vector<Eigen::Vector3f> out;
    const auto see = [&](const Eigen::Vector3f& p) {
      if ((p.head<2>() - here).norm() > range_m) return;
      out.push_back((lidar_T_world * p.cast<double>()).cast<float>() + Eigen::Vector3f(noise(), noise(), noise()));
    };
    for (const Eigen::Vector3f& p : points_) see(p);
    for (float x = std::floor(here.x()) - range_m; x < here.x() + range_m; x += 1.0F) {
      for (float y = std::floor(here.y()) - range_m; y < here.y() + range_m; y += 1.0F) see({x, y, 0});
    }
    return out;
  }
  [[nodiscard]] const std::vector<Eigen::Vector3f>& points() const { return points_; }

 private:
  float Between(float low, float high) {
    return low + (high - low) * static_cast<float>(random_() % 100000) / 100000.0F;
  }
  std::mt19937 random_;
  std::vector<Eigen::Vector3f> points_;
};

struct TownDrive {
  Recording recording;
  std::vector<geom::Pose3> truth;  // world_T_lidar, per scan
};

// A drive along x from x0 to x1 (either way round) at y, with 1 % drift, in a frame of its own.
inline TownDrive DriveAlong(const SyntheticTown& town, const std::string& name, double x0, double x1, double y,
                            unsigned seed) {
  TownDrive out;
  std::mt19937 random(seed);
  const auto u = [&] { return static_cast<double>(random() % 20001) / 10000.0 - 1; };
  const double direction = x1 > x0 ? 1 : -1;
  for (double s = 0; s <= std::abs(x1 - x0); s += 1.5) {
    geom::Pose3 pose;
    pose.t = {x0 + direction * s, y + 1.2 * std::sin(s / 25), 1.8};
    const double heading = (direction > 0 ? 0 : 3.14159265) + direction * std::atan(1.2 / 25 * std::cos(s / 25));
    pose.q = geom::Quatd(Eigen::AngleAxisd(heading, geom::Vec3d::UnitZ()));
    out.truth.push_back(pose);
  }
  geom::Pose3 odometry{{50 * u(), 50 * u(), 5 * u()}, geom::ExpSo3({0.2 * u(), 0.2 * u(), 3 * u()})};
  const double scale = 1 + 0.01 * u();
  const double bend_rad = 0.0003 * u();
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    if (i > 0) {
      geom::Pose3 step = out.truth[i - 1].Inverse() * out.truth[i];
      step.t *= scale;
      step.q = (step.q * geom::ExpSo3({0, 0, bend_rad})).normalized();
      odometry = odometry * step;
    }
    out.recording.world_T_lidar.push_back(odometry);
    out.recording.times.push_back({static_cast<std::int64_t>(i) * 100'000'000});
  }
  out.recording.name = name;
  out.recording.load_scan = [&town, truth = out.truth, seed](int i) {
    return town.Scan(truth[static_cast<std::size_t>(i)], seed * 1000 + static_cast<unsigned>(i));
  };
  return out;
}

}  // namespace mapweld::merge
