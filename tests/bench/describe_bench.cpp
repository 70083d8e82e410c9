// SPDX-License-Identifier: Apache-2.0
// What one description costs on this core, by method: describe_bench [ROUNDS]. Views of made-up towns, about as many
// points as a submap of a street has.
#include <time.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "core/base/assert.hpp"
#include "core/nn/kernels.hpp"
#include "core/place/describer.hpp"
#include "core/place/trained_code.hpp"
#include "tests/unit/core/place/made_up_town.hpp"

namespace {

using namespace mapweld;

double CpuMilliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

using Views = std::vector<std::unique_ptr<submap::Submap>>;

template <class Work>
void Measure(const char* name, const Views& views, int rounds, const Work& work) {
  std::vector<double> ms;
  for (int round = 0; round < rounds; ++round) {
    for (const auto& view : views) ms.push_back(work(*view));
  }
  std::sort(ms.begin(), ms.end());
  std::printf("%-26s %6.2f ms p50  %6.2f ms p99\n", name, ms[ms.size() / 2], ms[ms.size() * 99 / 100]);
}

void MeasureWhole(const char* name, place::Describer::Method method, const Views& views, int rounds) {
  const auto describer = std::make_unique<place::Describer>(method);
  place::PlaceDescription out;
  Measure(name, views, rounds, [&](const submap::Submap& view) {
    const double begun = CpuMilliseconds();
    (void)describer->Describe(view, &out);
    return CpuMilliseconds() - begun;
  });
}

// The part that tests/bench/float_network.py does in floating point: from the plan image to the code.
void MeasureNetwork(const Views& views, int rounds) {
  struct Machine {
    place::ColumnGrid grid;
    place::PlanImage image;
    place::TrainedCode code;
  };
  const auto machine = std::make_unique<Machine>();
  MAPWELD_ASSERT(machine->code.Open(place::CompiledModel(), nn::ChooseKernels(nn::DetectCpu())) == Status::kOk);
  std::array<float, place::kDescriptorDim> out{};
  Measure("trained, from the image on", views, rounds, [&](const submap::Submap& view) {
    (void)machine->grid.Build(view.points.span(), place::Describer::kMinPoints);
    machine->image.Build(machine->grid);
    const double begun = CpuMilliseconds();
    machine->code.Run(machine->image, out);
    return CpuMilliseconds() - begun;
  });
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 20;
  Views views;
  std::size_t points = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    views.push_back(place::testing::LookAt(place::testing::MakeTown(seed), {.with_ground = true, .seed = seed}));
    points += views.back()->points.size();
  }
  std::printf("%zu views of %zu points; working memory %zu kB, weights %zu kB\n", views.size(), points / views.size(),
              sizeof(place::Describer) / 1000, place::CompiledModel().size() / 1000);
  MeasureWhole("handmade", place::Describer::Method::kHandmade, views, rounds);
  MeasureWhole("trained", place::Describer::Method::kTrained, views, rounds);
  MeasureNetwork(views, rounds);
}
