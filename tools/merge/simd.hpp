// SPDX-License-Identifier: Apache-2.0
// Loops that the compiler vectorises by itself, compiled twice: for every processor that the project supports, and for
// those with AVX2, chosen when the program starts. Integer arithmetic only, so both give the same bits.
#pragma once

namespace mapweld::merge {

inline bool HasAvx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2");
#else
  return false;
#endif
}

}  // namespace mapweld::merge

// MAPWELD_SIMD_FUNCTION(int, Name, (int x, int y), { return x + y; }) defines a function object Name. The body must be
// a plain loop; calls in it must be inlined by the compiler.
#if defined(__x86_64__) && defined(__OPTIMIZE__)
#define MAPWELD_SIMD_FUNCTION(result, name, parameters, ...)                                                 \
  [[gnu::target("avx2")]] result name##Avx2 parameters __VA_ARGS__ result name##Plain parameters __VA_ARGS__ \
  result(*const name) parameters = ::mapweld::merge::HasAvx2() ? name##Avx2 : name##Plain;
#else
#define MAPWELD_SIMD_FUNCTION(result, name, parameters, ...) result name parameters __VA_ARGS__
#endif
