// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/merge/drive.hpp"

namespace mapweld::bench {

double CpuSeconds();  // of this process
double Median(std::vector<double> values);

// int8 operations (a multiply-add counts two) per CPU second of the instructions that a cosine kernel is made of, on
// registers alone: "avx2" or "avx512-vnni".
double CeilingOpsPerSecond(std::string_view kernel);

struct PeerResult {
  std::string what;
  double cpu_s = 0;
  std::string remark;
};
// FAISS on the same descriptors, one thread. Empty when this was built without it.
std::vector<PeerResult> MeasurePeers(const std::vector<merge::Drive>& drives);

}  // namespace mapweld::bench
