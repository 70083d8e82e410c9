// SPDX-License-Identifier: Apache-2.0
// Made-up descriptors of drives through a street grid: near places have near descriptors, every visit adds noise, and a
// part is common to all. For association alone, without submaps.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "tools/merge/drive.hpp"

namespace mapweld::test {

struct CityDescriptorsConfig {
  int drives = 50;
  int keyframes = 480;  // per drive, 5 m apart
  int blocks = 60;      // of 100 m, along each side of the town
  unsigned seed = 1;
  float reach_m = 8;    // within which the view changes
  float noise = 0.9F;   // of a visit, relative to the place
  float common = 0.5F;  // to all places
};

// keyframe.odom_T_body holds the true position.
class CityDescriptors {
 public:
  explicit CityDescriptors(const CityDescriptorsConfig& config) : config_(config), random_(config.seed) {
    for (std::size_t d = 0; d < kDim; ++d) {
      wave_x_[d] = Normal() / config.reach_m;
      wave_y_[d] = Normal() / config.reach_m;
      phase_[d] = 6.2831853F * Uniform();
      common_[d] = Normal() * config.common / 32;
    }
  }

  std::vector<merge::Drive> Make() {
    std::vector<merge::Drive> drives(static_cast<std::size_t>(config_.drives));
    for (std::size_t i = 0; i < drives.size(); ++i) drives[i] = MakeDrive(static_cast<int>(i));
    return drives;
  }

 private:
  static constexpr std::size_t kDim = place::kDescriptorDim;

  merge::Drive MakeDrive(int index) {
    merge::Drive drive;
    drive.name = "drive_" + std::to_string(1000 + index);
    int block_x = static_cast<int>(Uniform() * static_cast<float>(config_.blocks));
    int block_y = static_cast<int>(Uniform() * static_cast<float>(config_.blocks));
    int heading = static_cast<int>(Uniform() * 4) % 4;
    const float lane_m = 3 * (Uniform() - 0.5F);
    constexpr int kX[4] = {1, 0, -1, 0};
    constexpr int kY[4] = {0, 1, 0, -1};
    int step = 0;
    for (int k = 0; k < config_.keyframes; ++k) {
      if (step == 20) {
        block_x += kX[heading];
        block_y += kY[heading];
        step = 0;
        const float turn = Uniform();
        heading = (heading + (turn < 0.2F ? 1 : turn < 0.4F ? 3 : 0)) % 4;
        if (block_x < 1) heading = 0;
        if (block_x >= config_.blocks) heading = 2;
        if (block_y < 1) heading = 1;
        if (block_y >= config_.blocks) heading = 3;
      }
      const float along_m = 5.0F * static_cast<float>(step++);
      const auto dx = static_cast<float>(kX[heading]);
      const auto dy = static_cast<float>(kY[heading]);
      const float x_m = 100 * static_cast<float>(block_x) + dx * along_m - dy * lane_m;
      const float y_m = 100 * static_cast<float>(block_y) + dy * along_m + dx * lane_m;
      merge::Keyframe keyframe;
      keyframe.odom_T_body.t = {static_cast<double>(x_m), static_cast<double>(y_m), 0};
      keyframe.path_m = 5.0 * k;
      Describe(x_m, y_m, &keyframe.place.descriptor);
      drive.keyframes.push_back(keyframe);
    }
    return drive;
  }

  void Describe(float x_m, float y_m, place::PlaceDescriptor* out) {
    std::array<float, kDim> v{};
    float squared = 0;
    for (std::size_t d = 0; d < kDim; ++d) {
      v[d] = 0.0441942F * std::cos(wave_x_[d] * x_m + wave_y_[d] * y_m + phase_[d]) + config_.noise / 32 * Normal() +
             common_[d];
      squared += v[d] * v[d];
    }
    const float scale = 127.0F * 32 / 4.5F / std::sqrt(squared);
    for (std::size_t d = 0; d < kDim; ++d) {
      out->q[d] = static_cast<std::int8_t>(std::lround(std::fmax(-127.0F, std::fmin(127.0F, v[d] * scale))));
    }
    out->scale = 1 / (127.0F * 32 / 4.5F);
  }

  float Uniform() { return static_cast<float>(random_() >> 8U) / static_cast<float>(1U << 24U); }
  // Sum of four uniform numbers: near enough to normal, and quick.
  float Normal() {
    const std::uint64_t bits = (static_cast<std::uint64_t>(random_()) << 32U) | random_();
    float sum = 0;
    for (unsigned i = 0; i < 4; ++i) sum += static_cast<float>((bits >> (16 * i)) & 0xFFFFU) / 65536.0F;
    return (sum - 2) * 1.7320508F;
  }

  CityDescriptorsConfig config_;
  std::mt19937 random_;
  std::array<float, kDim> wave_x_{};
  std::array<float, kDim> wave_y_{};
  std::array<float, kDim> phase_{};
  std::array<float, kDim> common_{};
};

}  // namespace mapweld::test
