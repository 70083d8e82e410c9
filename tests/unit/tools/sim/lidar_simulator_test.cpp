// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/lidar_simulator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/unit/tools/sim/hall.hpp"
#include "tools/sim/velodyne_encoder.hpp"

namespace mapweld::sim {
namespace {

constexpr std::int64_t kStart_ns = 601'000'000'000;

// A decoder of its own, from the bytes, for what the encoder and the simulator promise together.
struct Point {
  double t;  // s past the hour
  geom::Vec3d lidar;
  int elevation_deg;
};

std::vector<Point> Decode(const std::array<std::uint8_t, 1206>& bytes) {
  const int elevation[16] = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
  const double t0 = 1e-6 * (bytes[1200] + 256.0 * (bytes[1201] + 256.0 * (bytes[1202] + 256.0 * bytes[1203])));
  std::vector<Point> points;
  for (std::size_t channel = 0; channel < 12 * 32; ++channel) {
    const std::size_t block = channel / 32;
    const std::size_t laser = channel % 16;
    const double since_block_us = 55.296 * static_cast<double>(channel % 32 / 16) + 2.304 * static_cast<double>(laser);
    const double azimuth_deg =
        0.01 * (bytes[block * 100 + 2] + 256 * bytes[block * 100 + 3]) + since_block_us * 3600e-6;
    const std::size_t at = block * 100 + 4 + channel % 32 * 3;
    const double r = 0.002 * (bytes[at] + 256 * bytes[at + 1]);
    if (r == 0) continue;
    const double a = azimuth_deg * std::numbers::pi / 180;
    const double w = elevation[laser] * std::numbers::pi / 180;
    const geom::Vec3d manual(r * std::cos(w) * std::sin(a), r * std::cos(w) * std::cos(a), r * std::sin(w));
    points.push_back({t0 + 1e-6 * (110.592 * static_cast<double>(block) + since_block_us),
                      {manual.y(), -manual.x(), manual.z()},
                      elevation[laser]});
  }
  return points;
}

class Lidar : public testing::Test {
 protected:
  const RayCaster caster_{{std::make_shared<RayScene>(Hall())}};
  const VehicleMotion motion_{LanePath::Beside({{0, 0}, {60, 0}}), DrivingStyle{}, Relief(0, 1), 3};
  [[nodiscard]] VelodynePacket Packet(std::int64_t index) const { return FireVelodynePacket(lidar_, index); }
  const LidarModel model_ = LidarByName("vlp16");
  const LidarSimulator lidar_{caster_, motion_, nullptr, model_, {}, kStart_ns, 77};
};

TEST_F(Lidar, HitsTheWorldFromWhereTheSensorIsAtEachFiring) {
  const auto first = static_cast<std::int64_t>(8.0 / 1.327104e-3);  // driving at about 6 m/s
  double worst = 0;
  double worst_without_motion = 0;
  std::size_t n = 0;
  for (std::int64_t i = first; i < first + 76; ++i) {
    for (const Point& p : Decode(EncodeVelodyne(Packet(i)))) {
      const double t = p.t - 1e-9 * static_cast<double>(kStart_ns);
      worst = std::max(worst, DistanceToHall(motion_.WorldFromBody(t) * (model_.body_T_lidar * p.lidar)));
      worst_without_motion =
          std::max(worst_without_motion, DistanceToHall(motion_.WorldFromBody(8.0) * (model_.body_T_lidar * p.lidar)));
      ++n;
    }
  }
  EXPECT_GT(n, 20000U);
  EXPECT_LT(worst, 3.47 * (model_.range_sigma_m + 60 * model_.divergence_rad) + 0.02);
  EXPECT_GT(worst_without_motion, 0.3) << "the drive is too slow to prove anything";
}

TEST_F(Lidar, LocksItsAngleToTheSecondAndStampsTheFirstFiring) {
  EXPECT_EQ(Packet(0).azimuth_cdeg[0], 0);
  EXPECT_EQ(Packet(0).us_past_hour, 601'000'000U);
  EXPECT_EQ(Packet(0).azimuth_cdeg[1], 40);  // 110.592 us at 0.36 degrees per ms: 39.8
  EXPECT_EQ(Packet(1).us_past_hour, 601'001'327U);
  EXPECT_EQ(Packet(1).azimuth_cdeg[0], 478);  // 477.76
  const VelodynePacket later = Packet(7535);  // 9.99972864 s
  EXPECT_EQ(later.us_past_hour, 610'999'728U);
  EXPECT_EQ(later.azimuth_cdeg[0], 35902);
  EXPECT_EQ(later.azimuth_cdeg[3], 22);  // past the zero
}

TEST_F(Lidar, GivesTheSamePacketWheneverItIsAsked) {
  const auto once = EncodeVelodyne(Packet(2000));
  (void)Packet(1);
  EXPECT_EQ(once, EncodeVelodyne(Packet(2000)));
  const LidarSimulator other(caster_, motion_, nullptr, model_, {}, kStart_ns, 78);
  EXPECT_NE(once, EncodeVelodyne(FireVelodynePacket(other, 2000)));
}

TEST_F(Lidar, PutsThePointsOfEveryModelOntoTheWorld) {
  for (const char* name : {"vlp16", "hdl32e", "hdl64e", "os1-64", "128"}) {
    const LidarModel model = LidarByName(name);
    const LidarSimulator lidar(caster_, motion_, nullptr, model, {}, kStart_ns, 7);
    std::vector<Eigen::Vector3f> points;
    const std::int64_t first = 8'000'000'000'000 / model.column_ps;
    for (std::int64_t c = first; c < first + lidar.ColumnsPerRevolution(); c += 16) lidar.AppendPoints(c, &points);
    const auto shots = static_cast<double>(model.beams.size()) * static_cast<double>(lidar.ColumnsPerRevolution()) / 16;
    EXPECT_GT(static_cast<double>(points.size()), 0.8 * shots) << name;
    double squares = 0;
    for (const Eigen::Vector3f& p : points) squares += std::pow(DistanceToHall(p.cast<double>()), 2);
    EXPECT_LT(std::sqrt(squares / static_cast<double>(points.size())), 0.06) << name << ": noise and beam width";
  }
}

TEST_F(Lidar, SendsTheLastAndTheStrongestReturnInPairsOfBlocks) {
  TownMesh fence = Hall();  // of thin posts: beams on their edges see the wall behind too
  for (int i = -30; i < 30; ++i) {
    Of(fence, Surface::kPole).AddWalls({{12.0, i + 0.0}, {12.1, i + 0.0}, {12.1, i + 0.1}, {12.0, i + 0.1}}, 0, 6);
  }
  const RayCaster caster{{std::make_shared<RayScene>(fence)}};
  const LidarSimulator lidar(caster, motion_, nullptr, model_, {}, kStart_ns, 77);
  std::size_t both = 0;
  std::size_t shots = 0;
  for (std::int64_t i = 0; i < 150; ++i) {
    const VelodynePacket single = FireVelodynePacket(lidar, i);
    for (std::int64_t half = 0; half < 2; ++half) {
      const VelodynePacket dual = FireVelodynePacket(lidar, 2 * i + half, true);
      EXPECT_EQ(dual.mode, VelodynePacket::kDualReturn);
      for (std::size_t block = 0; block < VelodynePacket::kBlocks; block += 2) {
        const std::size_t same = static_cast<std::size_t>(half) * 6 + block / 2;
        EXPECT_EQ(dual.azimuth_cdeg[block], dual.azimuth_cdeg[block + 1]);
        EXPECT_EQ(dual.azimuth_cdeg[block], single.azimuth_cdeg[same]);
        for (std::size_t channel = 0; channel < VelodynePacket::kReturnsPerBlock; ++channel) {
          const int last = dual.returns[block][channel].distance_2mm;
          const int nearer = dual.returns[block + 1][channel].distance_2mm;
          const int alone = single.returns[same][channel].distance_2mm;
          EXPECT_TRUE(alone == 0 || alone == last || alone == nearer) << "what the other mode sees is one of them";
          EXPECT_TRUE(last == nearer || last >= nearer + 499) << "two returns are a metre apart";
          both += last != nearer ? 1 : 0;
          shots += last != 0 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(both, 0U);
  EXPECT_LT(both, shots / 20) << "edges are rare";
}

TEST_F(Lidar, KeepsTheErrorOfEachBeam) {
  LidarModel right = LidarByName("hdl64e");
  right.beam_elevation_sigma_rad = 0;
  LidarModel wrong = right;
  right.beam_range_sigma_m = 0;
  const LidarSimulator one(caster_, motion_, nullptr, right, {}, kStart_ns, 7);
  const LidarSimulator other(caster_, motion_, nullptr, wrong, {}, kStart_ns, 7);
  std::vector<double> errors(right.beams.size(), 0);
  for (std::int64_t c = 0; c < 40; ++c) {
    std::vector<LidarReturn> a;
    std::vector<LidarReturn> b;
    one.Column(c, &a);
    other.Column(c, &b);
    for (std::size_t beam = 0; beam < a.size(); ++beam) {
      if (a[beam].distance_m <= 0) continue;
      const double error = static_cast<double>(b[beam].distance_m) - static_cast<double>(a[beam].distance_m);
      if (errors[beam] == 0) errors[beam] = error;
      EXPECT_NEAR(error, errors[beam], 1e-5);
    }
  }
  double squares = 0;
  for (const double error : errors) squares += error * error;
  EXPECT_NEAR(std::sqrt(squares / 64), wrong.beam_range_sigma_m, 0.01);
}

TEST_F(Lidar, ShowsMovingThingsWhereTheyAreAtEachFiring) {
  const LanePath lane = LanePath::Beside({{0, 0}, {60, 0}});
  const Relief flat(0, 1);
  const Traffic traffic(lane, motion_, flat, 3, 5);
  const LidarSimulator with(caster_, motion_, &traffic, model_, {}, kStart_ns, 77);
  std::size_t others = 0;
  for (std::int64_t c = 0; c < 150'000; c += 15) {
    std::vector<LidarReturn> empty;
    std::vector<LidarReturn> busy;
    lidar_.Column(c, &empty);
    with.Column(c, &busy);
    for (std::size_t i = 0; i < busy.size(); ++i) {
      if (busy[i].distance_m <= 0 || empty[i].distance_m <= 0) continue;
      EXPECT_LT(busy[i].distance_m, empty[i].distance_m + 0.01F) << "traffic hides, it never uncovers";
      others += busy[i].distance_m < empty[i].distance_m - 0.5F ? 1U : 0U;
    }
  }
  EXPECT_GT(others, 200U);
}

}  // namespace
}  // namespace mapweld::sim
