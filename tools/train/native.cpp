// SPDX-License-Identifier: Apache-2.0
// The agent's own view of a submap for the trainer (ctypes), so that training and vehicle cannot drift apart.
#include <cstdint>
#include <memory>
#include <vector>

#include "core/place/column_grid.hpp"
#include "core/place/describer.hpp"
#include "core/place/panorama.hpp"
#include "core/place/projection_spectrum.hpp"

using namespace mapweld;

namespace {
struct Scratch {
  submap::Submap submap;
  place::ColumnGrid grid;
  std::array<place::ProjectionSpectrum, 3> spectra;
  place::Panorama panorama;
  place::Describer describer;
};
Scratch& Memory() {
  thread_local auto scratch = std::make_unique<Scratch>();
  return *scratch;
}
bool Load(const float* xyz, std::int32_t n) {
  auto& points = Memory().submap.points;
  points.clear();
  for (std::int32_t i = 0; i < n && !points.full(); ++i) {
    (void)points.TryPush({.x = xyz[3 * i], .y = xyz[3 * i + 1], .z = xyz[3 * i + 2], .count = 2});
  }
  return n > 0;
}
}  // namespace

extern "C" {
// xyz: n x 3 metres, level frame. plan: [3 bands][48 bins][128 directions], bins 2..49. panorama: [32][64]. 0: refused.
int network_input(const float* xyz, std::int32_t n, float* plan, std::uint8_t* panorama) {
  if (!Load(xyz, n)) return 0;
  Scratch& s = Memory();
  if (s.grid.Build(s.submap.points.span(), 200) != Status::kOk) return 0;
  for (auto& spectrum : s.spectra) spectrum.Clear();
  s.grid.ForEach([&s](const place::Column& column) {
    s.spectra[0].Add(column, column.weight_q8);
    s.spectra[1].Add(column, column.tall_q8);
    s.spectra[2].Add(column, column.high_q8);
  });
  for (auto& spectrum : s.spectra) {
    spectrum.Transform();
    for (std::size_t f = 2; f < 50; ++f) {
      for (std::size_t d = 0; d < 128; ++d) *plan++ = spectrum.At(d, f);
    }
  }
  s.panorama.Build(s.submap.points.span());
  for (std::size_t row = 0; row < 32; ++row) {
    for (std::size_t column = 0; column < 64; ++column) *panorama++ = s.panorama.At(row, column);
  }
  return 1;
}
// q: 1024 int8 of the hand-made descriptor.
int handmade(const float* xyz, std::int32_t n, std::int8_t* q) {
  if (!Load(xyz, n)) return 0;
  place::PlaceDescription description;
  if (Memory().describer.Describe(Memory().submap, &description) != Status::kOk) return 0;
  std::copy(description.descriptor.q.begin(), description.descriptor.q.end(), q);
  return 1;
}
}
