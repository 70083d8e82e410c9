// SPDX-License-Identifier: Apache-2.0
#include "core/nn/kernels.hpp"

#include "core/nn/avx2.hpp"
#include "core/nn/neon.hpp"
#include "core/nn/vnni.hpp"

namespace mapweld::nn {
namespace {

constexpr Kernels kPortable{"portable", LinearPortable, LinearSumsPortable, SoftAssignPortable, PackRowsPortable};
#if defined(__x86_64__)
constexpr Kernels kAvx2{"avx2", LinearAvx2, LinearSumsAvx2, SoftAssignAvx2, PackRowsAvx2};
constexpr Kernels kAvx512Vnni{"avx512-vnni", LinearAvx512Vnni, LinearSumsAvx512Vnni, SoftAssignAvx2, PackRowsAvx2};
constexpr Kernels kAvxVnni{"avx-vnni", LinearAvxVnni, LinearSumsAvxVnni, SoftAssignAvx2, PackRowsAvx2};
#elif defined(__aarch64__)
constexpr Kernels kNeon{"neon", LinearNeon, LinearSumsNeon, SoftAssignPortable, PackRowsNeon};
constexpr Kernels kDotProduct{"neon-dot-product", LinearDotProduct, LinearSumsDotProduct, SoftAssignPortable,
                              PackRowsNeon};
#endif

#if defined(__x86_64__)
// cpuid leaf 7, subleaf 1. Compilers do not all know this feature by name.
bool HasAvxVnni() {
  std::uint32_t a = 7, b = 0, c = 1, d = 0;
  __asm__("cpuid" : "+a"(a), "=b"(b), "+c"(c), "=d"(d));
  return (a >> 4U & 1U) != 0;
}
#endif

}  // namespace

CpuFeatures DetectCpu() {
  CpuFeatures cpu;
#if defined(__x86_64__)
  __builtin_cpu_init();
  cpu.avx2 = __builtin_cpu_supports("avx2") != 0;
  cpu.avx512_vnni = cpu.avx2 && __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512vnni") != 0;
  cpu.avx_vnni = cpu.avx2 && HasAvxVnni();
#elif defined(__aarch64__)
  std::uint64_t isar0 = 0;
  __asm__("mrs %0, ID_AA64ISAR0_EL1" : "=r"(isar0));
  cpu.dot_product = (isar0 >> 44U & 0xFU) != 0;
#endif
  return cpu;
}

FixedVector<const Kernels*, 4> AllKernels(const CpuFeatures& cpu) {
  FixedVector<const Kernels*, 4> all;
  (void)all.TryPush(&kPortable);
#if defined(__x86_64__)
  if (cpu.avx2) (void)all.TryPush(&kAvx2);
  if (cpu.avx_vnni) (void)all.TryPush(&kAvxVnni);
  if (cpu.avx512_vnni) (void)all.TryPush(&kAvx512Vnni);
#elif defined(__aarch64__)
  (void)all.TryPush(&kNeon);
  if (cpu.dot_product) (void)all.TryPush(&kDotProduct);
#else
  (void)cpu;
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
