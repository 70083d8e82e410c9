// SPDX-License-Identifier: Apache-2.0
// Small made-up towns for the tests: house walls, hedges and poles at places drawn from a seed, looked at from
// anywhere.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
#include <vector>

#include "core/submap/submap.hpp"

namespace mapweld::place::testing {

// Own generator, so that a town is the same with every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 2862933555777941757ULL + 3037000493ULL) {}
  // 0 <= x < 1 in steps of 2^-24.
  float Uniform() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<float>(state_ >> 40U) * 0x1p-24F;
  }
  float Between(float low, float high) { return low + (high - low) * Uniform(); }

 private:
  std::uint64_t state_;
};

struct Point {
  float x = 0;
  float y = 0;
  float z = 0;
};

// Walls along a street on the x axis and two side streets, 240 m x 100 m.
inline std::vector<Point> MakeTown(std::uint64_t seed) {
  Dice dice(seed);
  std::vector<Point> town;
  const auto wall = [&town](float x0, float y0, float x1, float y1, float height) {
    const float length = std::hypot(x1 - x0, y1 - y0);
    const int steps = static_cast<int>(length / 0.25F) + 1;
    for (int i = 0; i <= steps; ++i) {
      const float f = static_cast<float>(i) / static_cast<float>(steps);
      for (float z = 0; z <= height; z += 0.25F) town.push_back({x0 + f * (x1 - x0), y0 + f * (y1 - y0), z});
    }
  };
  for (const float side : {-1.0F, 1.0F}) {
    for (float x = -120; x < 120; x += dice.Between(8, 22)) {
      const float width = dice.Between(5, 12);
      const float setback = dice.Between(7, 16);
      const float depth = dice.Between(6, 14);
      const float height = dice.Between(2, 7);
      wall(x, side * setback, x + width, side * setback, height);
      wall(x, side * setback, x, side * (setback + depth), height);
      wall(x + width, side * setback, x + width, side * (setback + depth), height);
    }
    for (int i = 0; i < 16; ++i) {
      const float x = dice.Between(-120, 120);
      const float y = side * dice.Between(5, 30);
      wall(x, y, x + dice.Between(0, 3), y + dice.Between(0, 3), dice.Between(1, 4));
    }
  }
  return town;
}

struct View {
  float x_m = 0;
  float y_m = 0;
  float yaw_rad = 0;  // heading, anticlockwise from the town's x axis
  float sensor_height_m = 1.8F;
  float dropped_share = 0;  // of the voxels
  float noise_m = 0;        // uniform, each axis
  bool with_ground = false;
  float slope = 0;  // of the ground and all that stands on it, along the town's x
  std::uint64_t seed = 1;
};

// The town as a submap: within 50 m, level frame, one mean per 0.5 m voxel.
inline std::unique_ptr<submap::Submap> LookAt(const std::vector<Point>& town, const View& view) {
  std::vector<Point> seen = town;
  if (view.with_ground) {
    for (float x = -120; x <= 120; x += 0.4F) {
      for (float y = -12; y <= 12; y += 0.4F) seen.push_back({x, y, 0});
    }
  }
  struct Sum {
    double x = 0, y = 0, z = 0;
    int n = 0;
  };
  std::map<std::array<int, 3>, Sum> voxels;
  Dice dice(view.seed);
  const float c = std::cos(view.yaw_rad);
  const float s = std::sin(view.yaw_rad);
  for (const Point& p : seen) {
    const float dx = p.x - view.x_m;
    const float dy = p.y - view.y_m;
    const float x = c * dx + s * dy + view.noise_m * dice.Between(-1, 1);
    const float y = -s * dx + c * dy + view.noise_m * dice.Between(-1, 1);
    const float z = p.z + view.slope * dx - view.sensor_height_m + view.noise_m * dice.Between(-1, 1);
    if (x * x + y * y + z * z > 50 * 50) continue;
    const auto cell = [](float v) { return static_cast<int>(std::floor(v / 0.5F)); };
    Sum& sum = voxels[{cell(z), cell(y), cell(x)}];
    sum.x += static_cast<double>(x), sum.y += static_cast<double>(y), sum.z += static_cast<double>(z);
    ++sum.n;
  }
  auto submap = std::make_unique<submap::Submap>();
  for (const auto& [key, sum] : voxels) {
    if (dice.Uniform() < view.dropped_share) continue;
    const submap::SubmapPoint point{.x = static_cast<float>(sum.x / sum.n),
                                    .y = static_cast<float>(sum.y / sum.n),
                                    .z = static_cast<float>(sum.z / sum.n),
                                    .count = static_cast<std::uint16_t>(sum.n)};
    if (submap->points.TryPush(point) != Status::kOk) break;
  }
  return submap;
}

constexpr float Degrees(float degrees) {
  return degrees * std::numbers::pi_v<float> / 180.0F;
}

}  // namespace mapweld::place::testing
