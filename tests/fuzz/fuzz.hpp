// SPDX-License-Identifier: Apache-2.0
// What every fuzz target provides and uses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

namespace mapweld::fuzz {

using Bytes = std::vector<std::uint8_t>;

// Good inputs to start from.
std::vector<Bytes> Seeds();

// For decoders of text.
inline std::vector<Bytes> TextSeeds(std::initializer_list<std::string_view> texts) {
  std::vector<Bytes> seeds;
  for (const std::string_view text : texts) seeds.emplace_back(text.begin(), text.end());
  return seeds;
}

// A promise of the decoder that must hold for any input.
inline void Require(bool promise, const char* text, const char* file, int line) {
  if (promise) return;
  std::fprintf(stderr, "%s:%d: broken: %s\n", file, line, text);
  std::abort();
}

// Reads the input bit by bit, as a source of decisions; zeros when it is used up.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : bytes_(data, size) {}
  [[nodiscard]] bool empty() const { return bytes_.empty(); }
  std::uint64_t Number(std::size_t bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) {
      value = (value << 8U) | (bytes_.empty() ? 0U : bytes_.front());
      if (!bytes_.empty()) bytes_ = bytes_.subspan(1);
    }
    return value;
  }
  // A copy of its own size, so that the address sanitizer sees its end.
  Bytes Take(std::size_t bytes) {
    const std::size_t n = bytes < bytes_.size() ? bytes : bytes_.size();
    Bytes out(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(n));
    bytes_ = bytes_.subspan(n);
    return out;
  }
  Bytes Rest() { return Take(bytes_.size()); }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace mapweld::fuzz

#define FUZZ_REQUIRE(promise) ::mapweld::fuzz::Require((promise), #promise, __FILE__, __LINE__)

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
