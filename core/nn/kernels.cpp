// SPDX-License-Identifier: Apache-2.0
#include "core/nn/kernels.hpp"

#include "core/nn/avx2.hpp"

namespace mapweld::nn {
namespace {

constexpr Kernels kPortable{"portable", LinearPortable, LinearSumsPortable, SoftAssignPortable, PackRowsPortable};
#if defined(__x86_64__)
constexpr Kernels kAvx2{"avx2", LinearAvx2, LinearSumsAvx2, SoftAssignAvx2, PackRowsAvx2};
#endif

}  // namespace

CpuFeatures DetectCpu() {
  CpuFeatures cpu;
#if defined(__x86_64__)
  __builtin_cpu_init();
  cpu.avx2 = __builtin_cpu_supports("avx2") != 0;
#endif
  return cpu;
}

FixedVector<const Kernels*, 4> AllKernels(const CpuFeatures& cpu) {
  FixedVector<const Kernels*, 4> all;
  (void)all.TryPush(&kPortable);
#if defined(__x86_64__)
  if (cpu.avx2) (void)all.TryPush(&kAvx2);
#endif
  return all;
}

const Kernels& PortableKernels() {
  return kPortable;
}
const Kernels& ChooseKernels(const CpuFeatures& cpu) {
  return *AllKernels(cpu).back();
}

}  // namespace mapweld::nn
