// SPDX-License-Identifier: Apache-2.0
// Random numbers that are a pure function of their place (seed, stream, counter) instead of a generator's history, so
// that a simulation gives the same bytes with any number of threads. No library functions: the same on every machine.
#pragma once

#include <cstdint>

namespace mapweld::sim {

// A well mixed 64-bit word; the finaliser of Steele, Lea, Flood, "Fast splittable pseudorandom number generators",
// 2014.
constexpr std::uint64_t Mix(std::uint64_t x) {
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

constexpr std::uint64_t Hash(std::uint64_t a, std::uint64_t b, std::uint64_t c = 0) {
  return Mix(Mix(Mix(a + 0x9E3779B97F4A7C15ULL) ^ b) + 0x9E3779B97F4A7C15ULL * (c + 1));
}

// 0 <= result < 1.
constexpr double Uniform(std::uint64_t bits) {
  return static_cast<double>(bits >> 11U) * 0x1.0p-53;
}
constexpr double Uniform(std::uint64_t bits, double low, double high) {
  return low + (high - low) * Uniform(bits);
}

// Nearly normal, mean 0, standard deviation 1, never beyond 3.47: the sum of four uniform numbers of 16 bits.
constexpr double Gaussian(std::uint64_t bits) {
  const std::uint64_t sum =
      (bits & 0xFFFFU) + ((bits >> 16U) & 0xFFFFU) + ((bits >> 32U) & 0xFFFFU) + ((bits >> 48U) & 0xFFFFU);
  constexpr double kMean = 2 * 65535.0;
  constexpr double kSigma = 37837.226;  // of the sum: 65536 * sqrt(4 / 12)
  return (static_cast<double>(sum) - kMean) / kSigma;
}

}  // namespace mapweld::sim
