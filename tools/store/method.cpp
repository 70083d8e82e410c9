// SPDX-License-Identifier: Apache-2.0
#include "tools/store/method.hpp"

#include <unistd.h>

#include <array>
#include <cstring>
#include <fstream>
#include <span>
#include <type_traits>

namespace mapweld::store {
namespace {

// FNV-1a, 64 bits.
std::uint64_t Hash(std::span<const char> bytes, std::uint64_t seed) {
  for (const char byte : bytes) {
    seed ^= static_cast<std::uint8_t>(byte);
    seed *= 0x100000001B3ULL;
  }
  return seed;
}

std::uint64_t HashOfProgram() {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  std::ifstream program("/proc/self/exe", std::ios::binary);
  // A program that cannot be read is like no other.
  if (!program) return Hash(std::to_array({static_cast<char>(::getpid())}), hash);
  std::array<char, 1 << 16> block;
  while (program.read(block.data(), block.size()) || program.gcount() > 0) {
    hash = Hash(std::span(block).first(static_cast<std::size_t>(program.gcount())), hash);
  }
  return hash;
}

}  // namespace

std::uint64_t MethodOf(const merge::MergeConfig& config) {
  static const std::uint64_t program = HashOfProgram();
  static_assert(std::is_trivially_copyable_v<merge::MergeConfig>, "every field must lie in the struct to be hashed");
  merge::MergeConfig plain = config;
  plain.threads = 0;
#if defined(__has_builtin) && __has_builtin(__builtin_clear_padding)
  __builtin_clear_padding(&plain);
#endif
  std::array<char, sizeof(plain)> bytes;
  std::memcpy(bytes.data(), &plain, sizeof(plain));
  return Hash(bytes, program);
}

}  // namespace mapweld::store
