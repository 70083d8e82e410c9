// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/store/city_store.hpp"

namespace mapweld::store {

// All that is known of why two drives are, or are not, in one map: what association saw, which test decided, every loop
// with its numbers. Throws StoreError when the store has no merge of the two. Cost: the two drives' difference matrix.
std::string Explain(CityStore* store, const std::string& name_a, const std::string& name_b);

}  // namespace mapweld::store
