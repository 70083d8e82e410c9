// SPDX-License-Identifier: Apache-2.0
// nn_bench [--json] [--rounds N]: CPU time of the int8 layers on one core, as a share of what the processor's byte
// products can do at most, beside XNNPACK on the same layer. Every round runs all of them; the best of each counts.
// Activations and weights are random, the weights narrow as the trainer makes them.
#include "tests/bench/nn/nn_bench.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "core/nn/conv2d.hpp"
#include "core/nn/net_vlad.hpp"
#include "tests/support/test_layer.hpp"

namespace mapweld::bench {
namespace {

using nn::Fill, nn::TestLayer;

struct Row {
  std::string name;
  double operations = 0;
  Work ours, peer;
  double best_ours = 1e9, best_peer = 1e9;
};

std::mt19937& Random() {
  static std::mt19937 random(1);
  return random;
}

double Time(const Work& work) {
  const double start = CpuSeconds();
  work();
  return CpuSeconds() - start;
}

Row Linear(const nn::Kernels& kernels, std::size_t count, std::size_t inputs, std::size_t outputs, Fill fill,
           int lowest) {
  const auto layer = std::make_shared<TestLayer>(inputs, outputs, fill, 0, &Random());
  const auto rows = nn::TestRows(count, inputs, lowest, false, &Random());
  Row row;
  row.name = std::to_string(count) + " x " + std::to_string(inputs) + " -> " + std::to_string(outputs);
  if (lowest < 0) row.name += ", signed";
  if (fill == Fill::kRandom) row.name += ", wide";
  row.operations = 2.0 * static_cast<double>(count * inputs * outputs);
  row.ours = [&kernels, layer, rows, count, checked = layer->layer(),
              out = std::vector<std::int8_t>(count * outputs)]() mutable {
    kernels.linear(checked, rows.data(), count, out.data());
  };
  row.peer = XnnpackLinear(count, inputs, outputs);
  return row;
}

Row Conv(const nn::Kernels& kernels, std::size_t height, std::size_t width, std::size_t channels, std::size_t outputs) {
  const nn::ConvGeometry g{height, width, channels, 3, 1, 1};
  const auto layer = std::make_shared<TestLayer>(g.inputs(), outputs, Fill::kNarrow, 0, &Random());
  const auto image = nn::TestRows(height * width, channels, 0, false, &Random());
  Row row;
  row.name = "conv 3x3 " + std::to_string(height) + " x " + std::to_string(width) + " x " + std::to_string(channels) +
             " -> " + std::to_string(outputs);
  row.operations = 2.0 * static_cast<double>(height * width * g.inputs() * outputs);
  row.ours = [&kernels, layer, image, checked = nn::MakeConv2d(g, layer->parameters).value(),
              scratch = std::vector<std::int8_t>(nn::ConvScratchBytes(g)),
              out = std::vector<std::int8_t>(height * width * outputs)]() mutable {
    nn::Conv2d(kernels, checked, image.data(), scratch, out.data());
  };
  row.peer = XnnpackConv(height, width, channels, 3, outputs);
  return row;
}

// The peer's part is the two products only, without softmax and normalisation.
Row Vlad(const nn::Kernels& kernels, std::size_t count, std::size_t channels, std::size_t clusters) {
  struct State {
    State(std::size_t c, std::size_t k)
        : layer(c, k, Fill::kNarrow, -127, &Random()), multiplier(k, 1 << 30), shift(k, 38), centres(c * k, 30.0F) {}
    TestLayer layer;
    std::vector<std::int32_t> multiplier, shift;
    std::vector<float> centres;
  };
  const auto state = std::make_shared<State>(channels, clusters);
  const auto rows = nn::TestRows(count, channels, 0, false, &Random());
  nn::NetVladParameters p{state->layer.parameters, {state->multiplier, state->shift}, state->centres, 1.0F / 512};
  p.assign.multiplier = p.assign.shift = {};
  Row row;
  row.name = "NetVLAD " + std::to_string(count) + " x " + std::to_string(channels) + ", " + std::to_string(clusters);
  row.operations = 4.0 * static_cast<double>(count * channels * clusters);
  row.ours = [&kernels, state, rows, count, channels, layer = nn::MakeNetVlad(p).value(),
              memory = std::vector<std::int32_t>(nn::NetVlad::Words(channels, clusters)),
              out = std::vector<std::int8_t>(channels * clusters)]() mutable {
    nn::NetVlad vlad(layer, kernels, memory);
    for (std::size_t m = 0; m < count; m += nn::NetVlad::kBlockRows) {
      if (vlad.AddBlock(rows.data() + m * channels, nn::NetVlad::kBlockRows) != Status::kOk) std::abort();
    }
    if (vlad.Finish(out.data()) != Status::kOk) std::abort();
  };
  const Work assign = XnnpackLinear(count, channels, clusters), gather = XnnpackLinear(clusters, count, channels);
  if (assign) row.peer = [assign, gather] { assign(), gather(); };
  return row;
}

void Print(const std::vector<Row>& rows, const char* kernels, double ceiling, bool json) {
  if (json) {
    std::printf("{\"kernels\": \"%s\", \"ceiling_gops\": %.1f, \"layers\": [", kernels, ceiling);
  } else {
    std::printf("kernels: %s; ceiling of maddubs + madd + add on this core: %.0f GOP/s\n", kernels, ceiling);
    std::printf("%-32s %8s %8s %8s %8s %10s %8s\n", "layer", "MOP", "ms", "GOP/s", "share", "XNNPACK ms", "ratio");
  }
  for (const Row& row : rows) {
    const double gops = row.operations / row.best_ours / 1e9;
    const double peer_ms = row.peer ? row.best_peer * 1e3 : 0, ratio = row.peer ? row.best_peer / row.best_ours : 0;
    std::printf(json ? "%s{\"layer\": \"%s\", \"mop\": %.2f, \"ms\": %.4f, \"gops\": %.1f, \"share\": %.3f, "
                       "\"xnnpack_ms\": %.4f, \"ratio\": %.3f}"
                     : "%s%-32s %8.2f %8.3f %8.1f %8.2f %10.3f %8.2f\n",
                json && &row != &rows.front() ? ", " : "", row.name.c_str(), row.operations / 1e6, row.best_ours * 1e3,
                gops, ceiling > 0 ? gops / ceiling : 0, peer_ms, ratio);
  }
  if (json) std::printf("]}\n");
}

int Main(int argc, char** argv) {
  bool json = false;
  int rounds = 25;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--json") == 0) {
      json = true;
    } else if (std::strcmp(argv[i], "--rounds") == 0 && i + 1 < argc) {
      rounds = std::max(1, std::atoi(argv[++i]));
    } else {
      std::fprintf(stderr, "usage: nn_bench [--json] [--rounds N]\n");
      return 2;
    }
  }
  const nn::CpuFeatures cpu = nn::DetectCpu();
  const nn::Kernels& kernels = nn::ChooseKernels(cpu);
  std::vector<Row> rows{Linear(kernels, 4096, 64, 64, Fill::kNarrow, 0),
                        Linear(kernels, 4096, 64, 128, Fill::kNarrow, 0),
                        Linear(kernels, 4096, 128, 128, Fill::kNarrow, 0),
                        Linear(kernels, 4096, 128, 128, Fill::kNarrow, -127),
                        Linear(kernels, 4096, 128, 128, Fill::kRandom, 0),
                        Linear(kernels, 1, 4096, 512, Fill::kNarrow, 0),
                        Linear(kernels, 1, 16384, 512, Fill::kNarrow, 0),
                        Vlad(kernels, 4096, 128, 32),
                        Conv(kernels, 32, 64, 16, 32),
                        Conv(kernels, 16, 32, 32, 64)};
  double ceiling = 0;
  for (int round = 0; round < rounds; ++round) {
    if (!json) std::fprintf(stderr, "\rround %d of %d", round + 1, rounds);
    if (cpu.avx2) {
      const double start = CpuSeconds();
      const double operations = RunInt8Ceiling();
      ceiling = std::max(ceiling, operations / (CpuSeconds() - start) / 1e9);
    }
    for (Row& row : rows) {
      row.best_ours = std::min(row.best_ours, Time(row.ours));
      if (row.peer) row.best_peer = std::min(row.best_peer, Time(row.peer));
    }
  }
  if (!json) std::fprintf(stderr, "\n");
  Print(rows, kernels.name, ceiling, json);
  return 0;
}

}  // namespace
}  // namespace mapweld::bench

int main(int argc, char** argv) {
  return mapweld::bench::Main(argc, argv);
}
