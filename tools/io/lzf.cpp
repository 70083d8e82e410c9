// SPDX-License-Identifier: Apache-2.0
#include "tools/io/lzf.hpp"

namespace mapweld::io {

bool DecompressLzf(std::string_view compressed, std::size_t size, std::string* bytes) {
  constexpr std::size_t kBestRatio = 264 / 3 + 1;  // the longest copy is 264 bytes out of three
  bytes->clear();
  if (size / kBestRatio > compressed.size()) return false;
  bytes->reserve(size);
  std::size_t at = 0;
  const auto next = [&] { return static_cast<std::size_t>(static_cast<unsigned char>(compressed[at++])); };
  while (at < compressed.size()) {
    const std::size_t control = next();
    if (control < 32) {
      const std::size_t literals = control + 1;
      if (literals > compressed.size() - at || literals > size - bytes->size()) return false;
      bytes->append(compressed.substr(at, literals));
      at += literals;
      continue;
    }
    std::size_t length = control >> 5U;
    if (length == 7) {
      if (at == compressed.size()) return false;
      length += next();
    }
    length += 2;
    if (at == compressed.size()) return false;
    const std::size_t distance = ((control & 31U) << 8U) + next() + 1;
    if (distance > bytes->size() || length > size - bytes->size()) return false;
    // Byte by byte: source and destination may overlap, which is how runs are coded.
    for (std::size_t from = bytes->size() - distance; length > 0; --length) bytes->push_back((*bytes)[from++]);
  }
  return bytes->size() == size;
}

}  // namespace mapweld::io
