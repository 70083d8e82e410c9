// SPDX-License-Identifier: Apache-2.0
// Text and numbers as the report shows them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace mapweld::report {

// Safe inside elements and double-quoted attributes. Bytes that are no UTF-8 become U+FFFD.
std::string EscapeHtml(std::string_view text);
// 1234567 -> "1 234 567", with narrow no-break spaces.
std::string Count(std::uint64_t value);
// "1 drive", "3 drives".
std::string Plural(std::uint64_t count, std::string_view noun);
// Metres as "12.3 km", "840 m", "1.3 m" or "12 cm", whatever reads best; a dash for what is no number.
std::string Length(double m);
// "950 B", "12.3 kB", "4.56 MB"; powers of 1000.
std::string Bytes(double bytes);
// "0.42 s", "12.8 s", "3 min 05 s".
std::string Duration(double seconds);
// "a, b and c".
template <class Range>
std::string Enumerate(const Range& words) {
  std::string text;
  std::size_t left = words.size();
  for (const auto& word : words) {
    text += word;
    --left;
    if (left > 0) text += left == 1 ? " and " : ", ";
  }
  return text;
}

}  // namespace mapweld::report
