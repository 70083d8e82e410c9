// SPDX-License-Identifier: Apache-2.0
// With libFuzzer, whose main calls this first: `fuzz.NAME --write DIR [CORPUS...]` only writes the seeds.
#include <cstdlib>

#include "tests/fuzz/seed_folder.hpp"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv);

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  if (mapweld::fuzz::WroteSeeds(*argc, *argv)) std::exit(0);
  return 0;
}
