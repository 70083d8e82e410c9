// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/status.hpp"
#include "core/place/descriptor.hpp"
#include "core/submap/submap.hpp"

namespace mapweld::place {

// Submap in, place description out. Owns its scratch memory; no heap. The same submap gives the same bytes.
// Refuses (kBadInput) submaps with fewer than kMinPoints points: a description that looks valid is never made up.
class Describer {
 public:
  static constexpr std::size_t kMinPoints = 200;
  Status Describe(const submap::Submap& submap, PlaceDescription* description);
};

}  // namespace mapweld::place
