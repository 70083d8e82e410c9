// SPDX-License-Identifier: Apache-2.0
// The agent's own view of a submap for the trainer (ctypes), so that training and vehicle cannot drift apart.
#include <cstdint>
#include <memory>

#include "core/place/column_grid.hpp"
#include "core/place/describer.hpp"
#include "core/place/plan_image.hpp"

namespace {

using namespace mapweld;

struct Scratch {
  submap::Submap submap;
  place::ColumnGrid grid;
  place::PlanImage image;
};

Scratch& Memory() {
  thread_local const auto scratch = std::make_unique<Scratch>();
  return *scratch;
}

}  // namespace

// xyz: [n][3] metres, level frame; image: [bands][rings][directions]. 0 when the agent would refuse these points.
extern "C" int mapweld_plan_image(const float* xyz, std::int32_t n, std::uint8_t* image) {
  Scratch& memory = Memory();
  memory.submap.points.clear();
  for (std::int32_t i = 0; i < n; ++i) {
    if (memory.submap.points.TryPush({.x = xyz[3 * i], .y = xyz[3 * i + 1], .z = xyz[3 * i + 2]}) != Status::kOk) break;
  }
  if (memory.grid.Build(memory.submap.points.span(), place::Describer::kMinPoints) != Status::kOk) return 0;
  memory.image.Build(memory.grid);
  for (std::size_t b = 0; b < place::PlanImage::kBands; ++b) {
    for (std::size_t ring = 0; ring < place::PlanImage::kRings; ++ring) {
      for (std::size_t d = 0; d < place::PlanImage::kDirections; ++d) *image++ = memory.image.At(b, ring, d);
    }
  }
  return 1;
}
