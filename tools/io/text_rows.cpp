// SPDX-License-Identifier: Apache-2.0
#include "tools/io/text_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace mapweld::io {
std::vector<std::string_view> SplitWords(std::string_view line) {
  constexpr std::string_view kBlanks = " \t,\r\v\f";
  std::vector<std::string_view> words;
  std::size_t begin = line.find_first_not_of(kBlanks);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::string ReadFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path)) {
    const int error = std::filesystem::is_directory(path) ? EISDIR : errno;
    throw std::runtime_error(fmt::format("cannot read {}: {}; check the path and that you may read it", path.string(),
                                         std::generic_category().message(error)));
  }
  std::string bytes;
  std::error_code unknown_size;
  const auto size = std::filesystem::file_size(path, unknown_size);
  if (!unknown_size) bytes.reserve(size);
  char block[1U << 16U];
  while (in.read(block, sizeof(block)) || in.gcount() > 0) bytes.append(block, static_cast<std::size_t>(in.gcount()));
  if (in.bad()) throw std::runtime_error(fmt::format("cannot read {}: the disk reports an error", path.string()));
  return bytes;
}

TextRows::TextRows(const std::filesystem::path& path) : path_(path), text_(ReadFile(path)) {
  std::string_view rest = text_;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);  // a byte order mark, which some editors leave
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    TextRow row{line, SplitWords(rest.substr(0, end))};
    if (!row.words.empty() && row.words.front().front() != '#') rows_.push_back(std::move(row));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

void TextRows::Fail(const TextRow& row, std::string_view what) const {
  throw std::runtime_error(fmt::format("{}:{}: {}", path_.string(), row.line, what));
}

void TextRows::ExpectColumns(const TextRow& row, std::size_t columns, std::string_view meaning) const {
  if (row.words.size() == columns) return;
  Fail(row, fmt::format("found {} numbers where {} belong ({}); repair or remove this line", row.words.size(), columns,
                        meaning));
}

double TextRows::Number(const TextRow& row, std::size_t column) const {
  double value = 0;
  const std::string_view word = row.words.at(column);
  if (!ParseNumber(word, &value)) {
    Fail(row, fmt::format("'{}' is not a number; repair or remove this line", word.substr(0, 40)));
  }
  if (!std::isfinite(value)) {
    Fail(row, fmt::format("column {} is {}; remove this line and its scan", column + 1, word.substr(0, 40)));
  }
  return value;
}

TimeNs TextRows::Seconds(const TextRow& row, std::size_t column) const {
  TimeNs t;
  if (!ParseSeconds(row.words.at(column), &t)) {
    Fail(row,
         fmt::format("'{}' is not a time in seconds; repair or remove this line", row.words.at(column).substr(0, 40)));
  }
  return t;
}

bool ParseNumber(std::string_view word, double* value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), *value);
  return error == std::errc() && end == word.data() + word.size();
}

bool ParseSeconds(std::string_view word, TimeNs* t) {
  double approximate = 0;
  if (!ParseNumber(word, &approximate) || !(std::abs(approximate) < 9.2e9)) return false;
  if (word.find_first_of("eE") != std::string_view::npos) {
    *t = {std::llround(approximate * 1e9)};
    return true;
  }
  const bool negative = word.starts_with('-');
  std::int64_t ns = 0;
  int decimals = -1;  // digits seen after the point; -1 before it
  for (const char c : word) {
    if (c == '.') decimals = 0;
    if (c < '0' || c > '9') continue;
    if (decimals == 9) {
      ns += c >= '5' ? 1 : 0;  // half up on the tenth digit
      break;
    }
    ns = ns * 10 + (c - '0');
    if (decimals >= 0) ++decimals;
  }
  for (int i = std::max(decimals, 0); i < 9; ++i) ns *= 10;
  *t = {negative ? -ns : ns};
  return true;
}

std::string FormatSeconds(TimeNs t) {
  const auto magnitude = t.ns < 0 ? 0 - static_cast<std::uint64_t>(t.ns) : static_cast<std::uint64_t>(t.ns);
  return fmt::format("{}{}.{:09}", t.ns < 0 ? "-" : "", magnitude / 1'000'000'000U, magnitude % 1'000'000'000U);
}

}  // namespace mapweld::io
