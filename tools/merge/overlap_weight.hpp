// SPDX-License-Identifier: Apache-2.0
// How strongly a verified overlap ties two drives (paper, eq. 9).
#pragma once

#include "tools/merge/merge_config.hpp"

namespace mapweld::merge {

// omega = exp(-(feature_distance_squared + C) / (2 L^2 + 1e-4)), C = 2 ln 2 * half_weight_overlap_m^2.
// omega is 1/2 where the features are equal and L = half_weight_overlap_m. Exactly 0 for length 0 or less:
// without a verified overlap there is no tie. feature_distance_squared is at most 4 for descriptors of unit length.
double OverlapWeight(double feature_distance_squared, double length_m, const WeightConfig& config);

}  // namespace mapweld::merge
