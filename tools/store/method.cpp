// SPDX-License-Identifier: Apache-2.0
#include "tools/store/method.hpp"

#include <array>
#include <cstring>
#include <fstream>
#include <type_traits>

#include "tools/store/database.hpp"
#include "tools/store/hash.hpp"

namespace mapweld::store {
namespace {

std::uint64_t HashOfProgram() {
  std::ifstream program("/proc/self/exe", std::ios::binary);
  if (!program) throw StoreError("cannot read /proc/self/exe, by which the store knows this program; mount /proc");
  std::uint64_t hash = kHashSeed;
  std::array<std::uint8_t, 1 << 16> block;
  while (program.read(reinterpret_cast<char*>(block.data()), block.size()) || program.gcount() > 0) {
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
  std::array<std::uint8_t, sizeof(plain)> bytes;
  std::memcpy(bytes.data(), &plain, sizeof(plain));
  return Hash(bytes, program);
}

}  // namespace mapweld::store
