// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/odometry_map.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "core/submap/rolling_map.hpp"
#include "core/submap/submap_codec.hpp"

namespace mapweld::odometry {
namespace {

// One point of ground every metre, seen by one keyframe of a drive of 4 m.
OdometryRun ShortRun() {
  auto map = std::make_unique<submap::RollingMap>();
  for (int x = -20; x < 20; ++x) {
    for (int y = -20; y < 20; ++y) {
      EXPECT_EQ(map->Insert({static_cast<float>(x) + 0.25F, static_cast<float>(y) + 0.25F, 0.25F}, 0), Status::kOk);
    }
  }
  auto submap = std::make_unique<submap::Submap>();
  EXPECT_EQ(map->Extract({}, 0, submap.get()), Status::kOk);
  KeyframeRecord keyframe;
  keyframe.t = TimeNs{1};
  keyframe.points = submap->points.size();
  keyframe.encoded.resize(kCap.submap_encoded_bytes);
  const auto n = std::make_unique<submap::SubmapEncoder>()->Encode(*submap, keyframe.encoded);
  EXPECT_TRUE(n.ok());
  keyframe.encoded.resize(n.value());
  OdometryRun run;
  run.keyframes.push_back(keyframe);
  for (int i = 0; i < 4; ++i) {
    ScanRecord scan;
    scan.update.t = TimeNs{i};
    scan.update.odom_T_body.t = {static_cast<double>(i), 0, 0};
    run.scans.push_back(scan);
  }
  return run;
}

TEST(OdometryMap, IsAPngThatIsTheSameEveryTime) {
  const std::string png = MapPng(ShortRun());
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png, MapPng(ShortRun()));
}

TEST(OdometryMap, OfADriveWithoutSubmapsIsRefusedWithAReason) {
  OdometryRun run;
  run.scans.resize(1);
  try {
    (void)MapPng(run);
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("no submap"), std::string::npos);
  }
}

}  // namespace
}  // namespace mapweld::odometry
