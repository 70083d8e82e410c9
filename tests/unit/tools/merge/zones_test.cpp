// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/zones.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace mapweld::merge {
namespace {

// A drive with a keyframe every 5 m along a curve. All views have the same signature with one peak, so that the
// relative yaw of any two of them is 0 in level frames.
Drive Curve(const geom::Pose3& odom_T_world, int count) {
  Drive drive;
  for (int k = 0; k < count; ++k) {
    const double s = 5.0 * k;
    Keyframe keyframe;
    keyframe.odom_T_body = odom_T_world * geom::Pose3{{200 * std::sin(s / 200), 200 * (1 - std::cos(s / 200)), 0},
                                                      geom::Quatd(Eigen::AngleAxisd(s / 200, geom::Vec3d::UnitZ()))};
    keyframe.path_m = s;
    keyframe.place.orientation.scale = 0.01F;
    for (std::size_t i = 0; i < keyframe.place.orientation.q.size(); ++i) {
      keyframe.place.orientation.q[i] =
          static_cast<std::int8_t>(std::lround(100 * std::exp(-static_cast<double>(i % 96) / 4)));
    }
    drive.keyframes.push_back(keyframe);
  }
  return drive;
}

TEST(EdgeTest, UsesTheRatioForLongEdges) {
  ZoneConfig config;
  EXPECT_TRUE(EdgesAgree(100, 85, config));
  EXPECT_FALSE(EdgesAgree(100, 75, config));
  EXPECT_FALSE(EdgesAgree(75, 100, config));
}

TEST(EdgeTest, ForgivesOneKeyframeSpacingOnShortEdges) {
  ZoneConfig config;
  EXPECT_TRUE(EdgesAgree(5, 0, config));
  EXPECT_TRUE(EdgesAgree(5, 10, config));
  EXPECT_FALSE(EdgesAgree(5, 12, config));
}

TEST(Zones, KeepATrueStretchAndLeaveAWrongMatchInItsMiddle) {
  const Drive a = Curve({}, 60);
  const Drive b = Curve({{30, -80, 0}, geom::Quatd(Eigen::AngleAxisd(1.3, geom::Vec3d::UnitZ()))}, 60);
  std::vector<Match> matches;
  for (int k = 20; k < 40; k += 4) matches.push_back({k, k, 5, true, false, false});
  matches.push_back({30, 34, 4, false, false, false});  // 20 m off, between good ones
  const std::vector<Zone> zones = FindZones(a, b, matches, {});
  ASSERT_GE(zones.size(), 2U);
  EXPECT_EQ(zones[0].matches.size(), 5U);
  for (const PlacedMatch& m : zones[0].matches) EXPECT_EQ(m.match.a, m.match.b);
  EXPECT_NEAR(geom::Yaw(zones[0].alignment.a_T_b.q), -1.3, 0.02);
}

TEST(Zones, AtTheEndsOfTheDrivesAreKeptWhateverTheirScore) {
  const Drive a = Curve({}, 200);
  std::vector<Match> matches;
  for (int k = 0; k < 15; ++k) matches.push_back({10 * k + 10, (70 * k) % 190, 3, false, false, false});
  matches.push_back({199, 0, 0, false, false, true});
  ZoneConfig config;
  config.max_zones = 4;
  const std::vector<Zone> zones = FindZones(a, a, matches, config);
  EXPECT_EQ(zones.size(), 5U);
  EXPECT_TRUE(std::any_of(zones.begin(), zones.end(), [](const Zone& z) { return z.matches.front().match.ends; }));
}

TEST(Zones, AreTheSameEveryTime) {
  const Drive a = Curve({}, 100);
  std::vector<Match> matches;
  for (int k = 0; k < 40; ++k) matches.push_back({(37 * k) % 100, (53 * k) % 100, 2.0 + k % 7, false, false, false});
  const auto x = FindZones(a, a, matches, {});
  const auto y = FindZones(a, a, matches, {});
  ASSERT_EQ(x.size(), y.size());
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(x[i].alignment.a_T_b.t, y[i].alignment.a_T_b.t);
}

}  // namespace
}  // namespace mapweld::merge
