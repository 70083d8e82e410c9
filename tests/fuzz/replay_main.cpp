// SPDX-License-Identifier: Apache-2.0
// Runs a fuzz target without a fuzzer: every seed, every file of the corpus folders named on the command line, and of
// each all truncations and all single-bit flips.
#include <cstdio>
#include <utility>

#include "tests/fuzz/seed_folder.hpp"

namespace {

using mapweld::fuzz::Bytes;

std::size_t RunAllVariants(const Bytes& seed) {
  for (std::size_t n = 0; n <= seed.size(); ++n) {
    const Bytes exact(seed.begin(), seed.begin() + static_cast<std::ptrdiff_t>(n));
    LLVMFuzzerTestOneInput(exact.data(), exact.size());
  }
  Bytes flipped = seed;
  for (std::size_t bit = 0; bit < 8 * seed.size(); ++bit) {
    const auto mask = static_cast<std::uint8_t>(1U << (bit % 8));
    flipped[bit / 8] ^= mask;
    LLVMFuzzerTestOneInput(flipped.data(), flipped.size());
    flipped[bit / 8] ^= mask;
  }
  return 9 * seed.size() + 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<Bytes> inputs = mapweld::fuzz::Seeds();
  for (int i = 1; i < argc; ++i) {
    for (Bytes& bytes : mapweld::fuzz::ReadFolder(argv[i])) inputs.push_back(std::move(bytes));
  }
  if (inputs.empty()) {
    std::fprintf(stderr, "no seeds: nothing was tested\n");
    return 1;
  }
  std::size_t runs = 0;
  for (const Bytes& input : inputs) runs += RunAllVariants(input);
  std::printf("%zu seeds, %zu runs\n", inputs.size(), runs);
  return 0;
}
