// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/overlap_weight.hpp"

#include <cmath>
#include <numbers>

namespace mapweld::merge {

double OverlapWeight(double feature_distance_squared, double length_m, const WeightConfig& config) {
  if (!(length_m > 0)) return 0;
  constexpr double kEpsilon = 1e-4;
  const double c = 2 * std::numbers::ln2 * config.half_weight_overlap_m * config.half_weight_overlap_m;
  return std::exp(-(feature_distance_squared + c) / (2 * length_m * length_m + kEpsilon));
}

}  // namespace mapweld::merge
