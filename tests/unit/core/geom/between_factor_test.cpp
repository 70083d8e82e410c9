// SPDX-License-Identifier: Apache-2.0
#include "core/geom/between_factor.hpp"

#include <gtest/gtest.h>

#include <random>

namespace mapweld::geom {
namespace {

Pose3 RandomPose(std::mt19937* rng) {
  std::normal_distribution<double> normal;
  Vec6d v;
  for (int i = 0; i < 6; ++i) v(i) = normal(*rng);
  return Retract({}, v);
}

TEST(BetweenFactor, IsZeroWhenThePosesFitTheMeasurement) {
  std::mt19937 rng(1);
  const Pose3 a = RandomPose(&rng);
  const Pose3 a_T_b = RandomPose(&rng);
  EXPECT_LT(BetweenResidual(a, a * a_T_b, a_T_b).norm(), 1e-9);
}

TEST(BetweenFactor, JacobiansMatchNumericDifferences) {
  std::mt19937 rng(2);
  for (int trial = 0; trial < 20; ++trial) {
    const Pose3 a = RandomPose(&rng);
    const Pose3 b = RandomPose(&rng);
    const Pose3 measured = Retract(a.Inverse() * b, 0.3 * LocalCoordinates({}, RandomPose(&rng)));
    const BetweenLinearization f = LinearizeBetween(a, b, measured);
    const double h = 1e-6;
    for (int k = 0; k < 6; ++k) {
      const Vec6d da = (BetweenResidual(Retract(a, h * Vec6d::Unit(k)), b, measured) - f.residual) / h;
      const Vec6d db = (BetweenResidual(a, Retract(b, h * Vec6d::Unit(k)), measured) - f.residual) / h;
      EXPECT_LT((da - f.jacobian_a.col(k)).norm(), 1e-4) << "a, column " << k;
      EXPECT_LT((db - f.jacobian_b.col(k)).norm(), 1e-4) << "b, column " << k;
    }
  }
}

}  // namespace
}  // namespace mapweld::geom
