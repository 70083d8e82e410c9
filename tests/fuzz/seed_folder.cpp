// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/seed_folder.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

namespace mapweld::fuzz {

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

bool WroteSeeds(int argc, char** argv) {
  if (argc < 3 || std::string(argv[1]) != "--write") return false;
  std::vector<Bytes> inputs = Seeds();
  for (int i = 3; i < argc; ++i) {
    for (Bytes& bytes : ReadFolder(argv[i])) inputs.push_back(std::move(bytes));
  }
  const fs::path folder = argv[2];
  fs::create_directories(folder);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    std::ofstream out(folder / ("seed" + std::to_string(i)), std::ios::binary);
    out.write(reinterpret_cast<const char*>(inputs[i].data()), static_cast<std::streamsize>(inputs[i].size()));
  }
  return true;
}

}  // namespace mapweld::fuzz
