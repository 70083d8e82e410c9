// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/clustering.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tools/merge/overlap_weight.hpp"

namespace mapweld::merge {
namespace {

using ::testing::ElementsAre;

Eigen::MatrixXd Weights(int n, const std::vector<std::tuple<int, int, double>>& ties) {
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(n, n);
  for (const auto& [i, k, weight] : ties) w(i, k) = w(k, i) = weight;
  return w;
}

WeightConfig Theta(double theta) {
  WeightConfig out;
  out.theta = theta;
  return out;
}

TEST(Clustering, SeparatesDrivesWithoutATie) {
  const auto groups = ClusterDrives(Weights(5, {{0, 3, 0.9}, {3, 4, 0.9}}), {});
  EXPECT_THAT(groups, ElementsAre(ElementsAre(0, 3, 4), ElementsAre(1), ElementsAre(2)));
}

TEST(Clustering, CutsTwoGroupsThatHardlyHoldTogether) {
  std::vector<std::tuple<int, int, double>> ties;
  for (int i = 0; i < 4; ++i) {
    for (int k = i + 1; k < 4; ++k) {
      ties.emplace_back(i, k, 0.95);
      ties.emplace_back(i + 4, k + 4, 0.95);
    }
  }
  ties.emplace_back(3, 4, 0.005);
  EXPECT_THAT(ClusterDrives(Weights(8, ties), {}), ElementsAre(ElementsAre(0, 1, 2, 3), ElementsAre(4, 5, 6, 7)));
  std::get<2>(ties.back()) = 0.5;
  EXPECT_EQ(ClusterDrives(Weights(8, ties), {}).size(), 1U);
}

TEST(Clustering, HoldsAChainOfGoodTiesTogether) {
  std::vector<std::tuple<int, int, double>> ties;
  for (int i = 0; i + 1 < 6; ++i) ties.emplace_back(i, i + 1, 0.9);
  EXPECT_EQ(ClusterDrives(Weights(6, ties), {}).size(), 1U);
}

TEST(Clustering, DoesNotCutALongLineOfDrives) {
  // The second eigenvalue of such a line is far below theta.
  for (const int n : {10, 40, 150}) {
    std::vector<std::tuple<int, int, double>> ties;
    for (int i = 0; i + 1 < n; ++i) ties.emplace_back(i, i + 1, 0.9);
    EXPECT_EQ(ClusterDrives(Weights(n, ties), {}).size(), 1U) << n;
  }
}

TEST(Clustering, CutsThreeGroupsThatHardlyHoldTogether) {
  std::vector<std::tuple<int, int, double>> ties;
  for (int group = 0; group < 3; ++group) {
    for (int i = 0; i < 3; ++i) ties.emplace_back(3 * group + i, 3 * group + (i + 1) % 3, 0.9);
  }
  ties.emplace_back(2, 3, 0.004);
  ties.emplace_back(5, 6, 0.004);
  EXPECT_THAT(ClusterDrives(Weights(9, ties), {}),
              ElementsAre(ElementsAre(0, 1, 2), ElementsAre(3, 4, 5), ElementsAre(6, 7, 8)));
}

TEST(Clustering, WithThetaZeroGivesConnectedComponents) {
  const auto groups = ClusterDrives(Weights(4, {{0, 1, 1e-6}, {2, 3, 1.0}}), Theta(0));
  EXPECT_THAT(groups, ElementsAre(ElementsAre(0, 1), ElementsAre(2, 3)));
}

TEST(OverlapWeight, IsOneHalfAtTheLengthThatBearsItsName) {
  WeightConfig config;
  config.half_weight_overlap_m = 25;
  EXPECT_NEAR(OverlapWeight(0, 25, config), 0.5, 1e-6);
}

TEST(OverlapWeight, IsExactlyZeroWithoutAnOverlap) {
  EXPECT_EQ(OverlapWeight(0, 0, {}), 0);
  EXPECT_EQ(OverlapWeight(0, -1, {}), 0);
  EXPECT_EQ(OverlapWeight(0, std::nan(""), {}), 0);
}

TEST(OverlapWeight, GrowsWithLengthAndFallsWithDifference) {
  EXPECT_LT(OverlapWeight(0.5, 20, {}), OverlapWeight(0.5, 40, {}));
  EXPECT_LT(OverlapWeight(2.0, 20, {}), OverlapWeight(0.1, 20, {}));
  EXPECT_LE(OverlapWeight(0, 1e9, {}), 1.0);
}

}  // namespace
}  // namespace mapweld::merge
