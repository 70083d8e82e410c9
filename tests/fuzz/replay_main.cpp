// SPDX-License-Identifier: Apache-2.0
// Runs a fuzz target without a fuzzer: every seed, every file of the corpus folders named on the command line, and of
// each all truncations and all single-bit flips. With --write DIR the seeds and corpus are only written there.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/fuzz/fuzz.hpp"

namespace {

using mapweld::fuzz::Bytes;
namespace fs = std::filesystem;

std::vector<Bytes> ReadFolder(const fs::path& folder) {
  std::vector<fs::path> files;
  if (fs::is_directory(folder)) {
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<Bytes> out;
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    out.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return out;
}

void WriteFolder(const fs::path& folder, const std::vector<Bytes>& inputs) {
  fs::create_directories(folder);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    std::ofstream out(folder / ("seed" + std::to_string(i)), std::ios::binary);
    out.write(reinterpret_cast<const char*>(inputs[i].data()), static_cast<std::streamsize>(inputs[i].size()));
  }
}

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
  fs::path write_to;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--write" && i + 1 < argc) {
      write_to = argv[++i];
      continue;
    }
    for (Bytes& bytes : ReadFolder(argv[i])) inputs.push_back(std::move(bytes));
  }
  if (inputs.empty()) {
    std::fprintf(stderr, "no seeds: nothing was tested\n");
    return 1;
  }
  if (!write_to.empty()) {
    WriteFolder(write_to, inputs);
    return 0;
  }
  std::size_t runs = 0;
  for (const Bytes& input : inputs) runs += RunAllVariants(input);
  std::printf("%zu seeds, %zu runs\n", inputs.size(), runs);
  return 0;
}
