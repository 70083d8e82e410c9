// SPDX-License-Identifier: Apache-2.0
// A way to recognise places: what turns a submap into bytes, and how far apart two of them are. Mapweld's own
// descriptors and the published ones it is measured against stand behind it, so that one evaluation serves all.
#pragma once

#include <vector>

#include "core/base/status.hpp"
#include "core/place/descriptor.hpp"
#include "core/submap/submap.hpp"

namespace mapweld::describe {

class PlaceMethod {
 public:
  virtual ~PlaceMethod() = default;

  // The 1024 + 192 bytes that travel and are stored. Whatever a method compares must be in them. Anything but kOk, with
  // *place untouched, for a submap that cannot be described. Not for two threads at once.
  virtual Status Describe(const submap::Submap& submap, place::PlaceDescription* place) = 0;

  // Whether the submap that was described last looks unlike what the method was trained on.
  [[nodiscard]] virtual bool IsUnfamiliar() const { return false; }

  // The same bytes made ready for many comparisons.
  using Features = std::vector<float>;
  [[nodiscard]] virtual Features Prepare(const place::PlaceDescription& place) const = 0;

  // Smaller is more alike; never NaN. Features of one method only. May be called from several threads.
  [[nodiscard]] virtual float Distance(const Features& a, const Features& b) const = 0;
};

}  // namespace mapweld::describe
