// SPDX-License-Identifier: Apache-2.0
// Drives that have nothing in common must stay apart, every time.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/support/city_descriptors.hpp"
#include "tools/merge/merge_pipeline.hpp"

namespace mapweld::merge {
namespace {

// Streets of boxes: each keyframe sees houses on both sides of a straight street, others at every keyframe. All streets
// look alike in kind, none is the same.
class RandomStreets : public SubmapSource {
 public:
  std::shared_ptr<const SubmapCloud> Find(SubmapKey key) override {
    ++asked;
    std::mt19937 random(static_cast<std::uint32_t>(key.drive * 100003 + key.keyframe));
    const auto between = [&](float low, float high) {
      return low + (high - low) * static_cast<float>(random() % 10000) / 10000.0F;
    };
    auto cloud = std::make_shared<SubmapCloud>();
    for (float x = -45; x < 45; x += 1.5F) {
      for (float y = -12; y < 12; y += 1.5F) cloud->points.emplace_back(x, y, between(-0.1F, 0.1F));
    }
    for (const float side : {-1.0F, 1.0F}) {
      for (float x = -48; x < 45;) {
        const float width = between(6, 14);
        const float front = side * between(7, 12);
        const float height = between(3, 8);
        for (float z = 0.25F; z < height; z += 0.5F) {
          for (float at = 0; at < width; at += 0.5F) cloud->points.emplace_back(x + at, front, z);
          for (float at = 0; at < 8; at += 0.5F) cloud->points.emplace_back(x, front + side * at, z);
        }
        x += width + between(1, 8);
      }
    }
    return cloud;
  }
  std::atomic<int> asked = 0;
};

TEST(MergeDrives, NeverMergesAnyOfAThousandUnrelatedPairs) {
  std::vector<Drive> drives;
  for (unsigned town = 1; town <= 46; ++town) {
    test::CityDescriptorsConfig config;
    config.drives = 1;
    config.keyframes = 100;
    config.seed = town;
    Drive drive = test::CityDescriptors(config).Make().front();
    drive.name = "town_" + std::to_string(100 + town);
    drives.push_back(std::move(drive));
  }
  RandomStreets submaps;
  const MergeResult result = MergeDrives(drives, submaps, {}, nullptr);
  EXPECT_EQ(result.groups.size(), drives.size());  // 1035 pairs
  for (const Overlap& overlap : result.overlaps) {
    EXPECT_FALSE(overlap.accepted) << overlap.drive_a << "-" << overlap.drive_b;
    EXPECT_FALSE(overlap.test.empty());
  }
  EXPECT_EQ(result.overlaps.size(), 1035U);  // each was looked at: the ends of all drives were laid on each other
}

}  // namespace
}  // namespace mapweld::merge
