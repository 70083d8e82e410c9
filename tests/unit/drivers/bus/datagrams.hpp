// SPDX-License-Identifier: Apache-2.0
// LCM datagrams, good and bad, made for tests.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mapweld::bus::test {

using Bytes = std::vector<std::uint8_t>;

inline void Put(Bytes* out, std::uint64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i)
    out->push_back(static_cast<std::uint8_t>(value >> (8U * static_cast<unsigned>(i))));
}

inline void Put(Bytes* out, std::string_view text) {
  for (const char c : text) out->push_back(static_cast<std::uint8_t>(c));
}

inline Bytes Short(std::uint32_t sequence, std::string_view channel, std::span<const std::uint8_t> payload) {
  Bytes out;
  Put(&out, 0x4C433032, 4);
  Put(&out, sequence, 4);
  Put(&out, channel);
  out.push_back(0);
  out.insert(out.end(), payload.begin(), payload.end());
  return out;
}

struct FragmentSpec {
  std::uint32_t sequence = 1;
  std::uint32_t size = 0;
  std::uint32_t offset = 0;
  unsigned number = 0;
  unsigned count = 1;
  std::string channel = "CH";  // sent with fragment 0
};

inline Bytes Fragment(const FragmentSpec& spec, std::span<const std::uint8_t> piece) {
  Bytes out;
  Put(&out, 0x4C433033, 4);
  Put(&out, spec.sequence, 4);
  Put(&out, spec.size, 4);
  Put(&out, spec.offset, 4);
  Put(&out, spec.number, 2);
  Put(&out, spec.count, 2);
  if (spec.number == 0) {
    Put(&out, spec.channel);
    out.push_back(0);
  }
  out.insert(out.end(), piece.begin(), piece.end());
  return out;
}

inline Bytes Pattern(std::size_t bytes, unsigned seed = 0) {
  Bytes out(bytes);
  for (std::size_t i = 0; i < bytes; ++i) out[i] = static_cast<std::uint8_t>(i * 31 + seed * 7 + (i >> 8U));
  return out;
}

// Datagrams that made one LCM implementation or another read or write out of bounds, loop, reserve memory or deliver
// what was never sent. Each stands for itself; a receiver refuses them all or waits for more.
inline std::vector<Bytes> HostileDatagrams() {
  std::vector<Bytes> out;
  out.push_back(Fragment({.size = 1024, .offset = 0xFFFFFFF0, .number = 1, .count = 2}, Pattern(32)));
  out.push_back(Fragment({.size = 1024, .offset = 0xFFFFFFF0, .number = 0, .count = 2}, Pattern(32)));
  out.push_back(Fragment({.size = 0x10000000, .number = 0, .count = 5000}, Pattern(10)));
  out.push_back(Fragment({.size = 100, .number = 0, .count = 0}, Pattern(10)));
  out.push_back(Fragment({.size = 100, .number = 0, .count = 65535}, Pattern(10)));
  out.push_back(Fragment({.size = 100, .number = 5, .count = 5}, Pattern(10)));
  out.push_back(Fragment({.size = 0xFFFFFFFF, .offset = 0xFFFFFFFF, .number = 1, .count = 2}, Pattern(1)));
  out.push_back(Fragment({.size = 10, .number = 0, .count = 1}, {}));
  out.push_back(Fragment({.size = 10, .number = 0, .count = 1, .channel = std::string(300, 'A')}, Pattern(10)));
  for (const std::size_t bytes : {0U, 1U, 4U, 7U}) {
    Bytes cut = Fragment({.size = 10, .number = 0, .count = 1}, Pattern(10));
    cut.resize(bytes);
    out.push_back(cut);
  }
  Bytes header_only = Fragment({.size = 10, .number = 1, .count = 2}, {});
  header_only.resize(19);
  out.push_back(header_only);
  Bytes no_nul;
  Put(&no_nul, 0x4C433032, 4);
  Put(&no_nul, 5, 4);
  Put(&no_nul, std::string(20, 'A'));
  out.push_back(no_nul);
  out.push_back(Short(1, std::string(64, 'A'), {}));
  out.push_back(Short(1, std::string(256, 'A'), {}));
  out.push_back(Short(1, "", Pattern(4)));
  out.push_back(Bytes(8, 0));
  return out;
}

}  // namespace mapweld::bus::test
