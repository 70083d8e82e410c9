// SPDX-License-Identifier: Apache-2.0
// The decoder against real packets and the cloud that a vendor's decoder made of them.
#include <memory>

#include "drivers/lidar/hesai_xt32_codec.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/unit/drivers/lidar/recordings.hpp"

namespace mapweld::lidar {
namespace {

// The angles of the sensor that was recorded, degrees. Its correction file is not part of the recording: these are the
// medians of the vendor's cloud, rounded to 0.001 degrees as such files are.
constexpr std::array<double, 32> kElevation{14.972, 13.952,  12.939,  11.931,  10.926,  9.922,   8.917,   7.917,
                                            6.920,  5.920,   4.922,   3.925,   2.930,   1.936,   0.945,   -0.048,
                                            -1.040, -2.036,  -3.029,  -4.025,  -5.020,  -6.016,  -7.014,  -8.014,
                                            -9.011, -10.011, -11.006, -12.004, -12.996, -13.997, -15.005, -16.024};
constexpr std::array<double, 32> kAzimuth{0.082,  0.077,  0.078,  0.076,  0.064,  0.060,  0.049,  0.045,
                                          0.034,  0.028,  0.021,  0.014,  0.009,  -0.001, -0.007, -0.015,
                                          -0.026, -0.031, -0.038, -0.046, -0.061, -0.066, -0.069, -0.077,
                                          -0.088, -0.092, -0.098, -0.093, -0.102, -0.104, -0.119, -0.130};

class HesaiRecording : public testing::TestWithParam<bool> {};

TEST_P(HesaiRecording, AgreesWithTheVendorsCloud) {
  const bool own_angles = GetParam();
  const auto bag = mapweld::test::SharedData("packets/xt32/1673400677802009732_0.db3");
  const auto pcd = mapweld::test::SharedData("packets/xt32/1673400678101968885.pcd");
  if (!bag || !pcd) GTEST_SKIP() << "packets/xt32 is not in the shared data folder";
  HesaiXt32Codec codec;
  if (own_angles) {
    BeamTable table;
    table.beams = 32;
    std::copy(kElevation.begin(), kElevation.end(), table.elevation_deg.begin());
    std::copy(kAzimuth.begin(), kAzimuth.end(), table.azimuth_deg.begin());
    codec.SetAngles(table);
  }
  auto packet = std::make_unique<sensor::LidarPacket>();
  test::CloudIndex index;
  std::int64_t last_ns = -1;
  for (const test::Payload& payload : test::PacketsOfBag(*bag, 1500, true)) {
    ASSERT_EQ(codec.Decode(payload, {}, packet.get()), Status::kOk);
    ASSERT_GT(packet->t.ns, last_ns);
    last_ns = packet->t.ns;
    // The vendor's frame has y forward and x to the right.
    for (const sensor::LidarPoint& point : packet->points)
      index.Add(-double{point.y}, double{point.x}, double{point.z});
  }
  EXPECT_EQ(codec.counters().packets, 2000U);
  EXPECT_EQ(codec.counters().lost, 0U);
  const auto cloud = test::VendorCloud(*pcd, 12);
  double worst_m = 0;
  const double share = index.ShareWithin(own_angles ? 0.005 : 0.025, cloud, &worst_m);
  std::printf("Xt32, %s angles: %.3f %% of %zu points within %s, worst %.4f m\n", own_angles ? "its own" : "nominal",
              100 * share, cloud.size(), own_angles ? "5 mm" : "25 mm", worst_m);
  EXPECT_GE(share, 0.999);
}

INSTANTIATE_TEST_SUITE_P(Angles, HesaiRecording, testing::Bool(),
                         [](const auto& own) { return own.param ? "Own" : "Nominal"; });

}  // namespace
}  // namespace mapweld::lidar
