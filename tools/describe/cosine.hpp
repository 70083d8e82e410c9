// SPDX-License-Identifier: Apache-2.0
// The comparison that most descriptors share.
#pragma once

#include "tools/describe/place_method.hpp"

namespace mapweld::describe {

// The first `size` elements of the descriptor, scaled to length 1. All zeros stay all zeros.
PlaceMethod::Features UnitFeatures(const place::PlaceDescriptor& descriptor, int size);

// 1 - a . b of equally long unit vectors: 0..2, and 1 to zeros. Independent of the machine up to the last bits.
float CosineDistance(const PlaceMethod::Features& a, const PlaceMethod::Features& b);

}  // namespace mapweld::describe
