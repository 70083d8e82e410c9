// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tools/sim/candump.hpp"
#include "tools/sim/imu_noise.hpp"
#include "tools/sim/xsens_encoder.hpp"

namespace mapweld::sim {
namespace {

std::int16_t BigEndian16(const CanFrame& frame, std::size_t at) {
  return static_cast<std::int16_t>(frame.data[at] << 8U | frame.data[at + 1]);
}

TEST(XsensEncoder, WritesTheFramesOfOneSampleInOrder) {
  const auto frames = EncodeXsens({6'010'050, 0x1234, {0.5, -1.0, 0.001}, {0, -9.81, 9.81}});
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_EQ(CandumpLine(0, frames[0]), "(0000000000.000000) can0 005#005BB4C2\n");
  EXPECT_EQ(CandumpLine(0, frames[1]), "(0000000000.000000) can0 006#1234\n");
  EXPECT_EQ(CandumpLine(0, frames[2]), "(0000000000.000000) can0 011#00000043\n");
  // 0.5 * 512 = 256, -512, 0.512 -> 1
  EXPECT_EQ(CandumpLine(0, frames[3]), "(0000000000.000000) can0 032#0100FE000001\n");
  // 9.81 * 256 = 2511.36 -> 2511 = 0x09CF
  EXPECT_EQ(CandumpLine(0, frames[4]), "(0000000000.000000) can0 034#0000F63109CF\n");
}

TEST(XsensEncoder, RoundsToTheNearestStep) {
  const auto frames = EncodeXsens({0, 0, {1.49 / 512, 1.51 / 512, -1.51 / 512}, {0, 0, 0}});
  EXPECT_EQ(BigEndian16(frames[3], 0), 1);
  EXPECT_EQ(BigEndian16(frames[3], 2), 2);
  EXPECT_EQ(BigEndian16(frames[3], 4), -2);
}

TEST(XsensEncoder, StopsAtTheRangeAndSaysSo) {
  const auto frames = EncodeXsens({0, 0, {0, 0, -70}, {200, 0, 0}});
  EXPECT_EQ(BigEndian16(frames[4], 0), 32767);
  EXPECT_EQ(BigEndian16(frames[3], 4), -32768);
  // Bit 8: acceleration x; bit 13: rate z; bit 19: anything.
  EXPECT_EQ(CandumpLine(0, frames[2]), "(0000000000.000000) can0 011#00082143\n");
}

TEST(Candump, WritesSecondsWithSixDecimals) {
  const CanFrame frame{0x032, 2, {0xAB, 0x01}};
  EXPECT_EQ(CandumpLine(601'000'400'999, frame), "(0000000601.000400) can0 032#AB01\n");
  EXPECT_EQ(CandumpLine(1'436'509'052'249'713'000, frame), "(1436509052.249713) can0 032#AB01\n");
}

TEST(ImuNoise, TremblesAsMuchAsAsked) {
  const ImuModel still;
  ImuModel trembling;
  trembling.vibration_mps2 = 1.5;
  constexpr std::uint64_t kSamples = 20000;
  geom::Vec3d accel = geom::Vec3d::Zero();
  geom::Vec3d gyro = geom::Vec3d::Zero();
  geom::Vec3d sum = geom::Vec3d::Zero();
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    const double t = static_cast<double>(i) / still.rate_hz;
    const ImuError a = DrawImuError(still, 5, i, t);
    const ImuError b = DrawImuError(trembling, 5, i, t);
    accel += (b.accel - a.accel).cwiseAbs2();
    gyro += (b.gyro - a.gyro).cwiseAbs2();
    sum += b.accel - a.accel;
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(std::sqrt(accel[axis] / kSamples), 1.5, 0.03);
    EXPECT_NEAR(sum[axis] / kSamples, 0, 0.01) << "trembling is no bias";
    // 12 to 80 Hz, half a metre: 1.5 / 0.5 / (2 pi f).
    EXPECT_GT(std::sqrt(gyro[axis] / kSamples), 3 / (2 * 3.15 * 80));
    EXPECT_LT(std::sqrt(gyro[axis] / kSamples), 3 / (2 * 3.14 * 12));
  }
}

TEST(ImuNoise, HasTheDensitiesOfTheDataSheet) {
  const ImuModel model;
  constexpr int kSamples = 20000;
  geom::Vec3d sum = geom::Vec3d::Zero();
  geom::Vec3d squares = geom::Vec3d::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const geom::Vec3d gyro = DrawImuError(model, 5, static_cast<std::uint64_t>(i), 1.0).gyro;
    sum += gyro;
    squares += gyro.cwiseProduct(gyro);
  }
  const geom::Vec3d mean = sum / kSamples;
  const geom::Vec3d sigma = (squares / kSamples - mean.cwiseProduct(mean)).cwiseSqrt();
  const double expected = 0.007 * 3.14159265 / 180 * std::sqrt(200.0);  // rad/s per sample
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(sigma[axis], expected, 0.03 * expected);
    EXPECT_LT(std::abs(mean[axis]), 4 * model.gyro_bias_sigma);
  }
  EXPECT_GT((mean - DrawImuError(model, 6, 0, 1.0).gyro).norm(), 1e-4) << "another seed, another bias";
}

TEST(ImuNoise, ChangesItsBiasSlowly) {
  ImuModel model;
  model.gyro_noise_density = 0;
  model.accel_noise_density = 0;
  const ImuError before = DrawImuError(model, 9, 0, 10);
  const ImuError after = DrawImuError(model, 9, 200, 11);
  EXPECT_LT((before.gyro - after.gyro).norm(), 3e-5);
  EXPECT_LT((before.accel - after.accel).norm(), 5e-4);
  EXPECT_NE(before.gyro, after.gyro);
}

}  // namespace
}  // namespace mapweld::sim
