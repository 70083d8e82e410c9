// SPDX-License-Identifier: Apache-2.0
// What one description costs on this core, by method: describe_bench [ROUNDS]. Views of made-up towns, about as many
// points as a submap of a street has.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

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

void Measure(const char* name, place::Describer::Method method,
             const std::vector<std::unique_ptr<submap::Submap>>& views, int rounds) {
  const auto describer = std::make_unique<place::Describer>(method);
  place::PlaceDescription out;
  std::vector<double> ms;
  for (int round = 0; round < rounds; ++round) {
    for (const auto& view : views) {
      const double begun = CpuMilliseconds();
      (void)describer->Describe(*view, &out);
      ms.push_back(CpuMilliseconds() - begun);
    }
  }
  std::sort(ms.begin(), ms.end());
  std::printf("%-9s %6.2f ms p50  %6.2f ms p99\n", name, ms[ms.size() / 2], ms[ms.size() * 99 / 100]);
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 20;
  std::vector<std::unique_ptr<submap::Submap>> views;
  std::size_t points = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    views.push_back(place::testing::LookAt(place::testing::MakeTown(seed), {.with_ground = true, .seed = seed}));
    points += views.back()->points.size();
  }
  std::printf("%zu views of %zu points; working memory %zu kB, weights %zu kB\n", views.size(), points / views.size(),
              sizeof(place::Describer) / 1000, place::CompiledModel().size() / 1000);
  Measure("handmade", place::Describer::Method::kHandmade, views, rounds);
  Measure("trained", place::Describer::Method::kTrained, views, rounds);
}
