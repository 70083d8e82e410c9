// SPDX-License-Identifier: Apache-2.0
// The inner loops of the layers for the machine the program runs on, chosen once at start. All give the same bytes.
#pragma once

#include "core/base/fixed_vector.hpp"
#include "core/nn/linear.hpp"
#include "core/nn/pack_rows.hpp"
#include "core/nn/soft_assignment.hpp"

namespace mapweld::nn {

struct CpuFeatures {
  bool avx2 = false;
  bool avx_vnni = false;     // VEX-coded dot product
  bool avx512_vnni = false;  // with VL
  bool dot_product = false;  // of ARMv8.2
};
// Asks the processor by instructions that need no operating system: cpuid, and on aarch64 a register that Linux lets
// programs read since 4.11.
CpuFeatures DetectCpu();

struct Kernels {
  const char* name;
  LinearFunction linear;
  LinearSumsFunction linear_sums;
  SoftAssignFunction soft_assign;
  PackRowsFunction pack_rows;
};
const Kernels& PortableKernels();
// The fastest for these features.
const Kernels& ChooseKernels(const CpuFeatures& cpu);
// Everything that runs with these features, the portable one first, the fastest last: for tests and benchmarks.
FixedVector<const Kernels*, 4> AllKernels(const CpuFeatures& cpu);

}  // namespace mapweld::nn
