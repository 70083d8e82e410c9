// SPDX-License-Identifier: Apache-2.0
// A text file of numbers in rows, as trajectories and time stamps come. Empty lines and lines that begin with '#' do
// not count; words are separated by blanks, tabs or commas; CRLF is accepted. Numbers are read the same way under every
// locale. Whatever does not parse throws one sentence with file and line.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/time.hpp"

namespace mapweld::io {

// The whole file as bytes. Throws when it cannot be read.
std::string ReadFile(const std::filesystem::path& path);

// The words of one line, without the separators.
std::vector<std::string_view> SplitWords(std::string_view line);

struct TextRow {
  int line = 0;  // 1-based
  std::vector<std::string_view> words;
};

class TextRows {
 public:
  explicit TextRows(const std::filesystem::path& path);
  TextRows(const TextRows&) = delete;
  TextRows& operator=(const TextRows&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const std::vector<TextRow>& rows() const { return rows_; }
  // Throws unless the row has exactly `columns` words; `meaning` names what they should be.
  void ExpectColumns(const TextRow& row, std::size_t columns, std::string_view meaning) const;
  // A finite number.
  [[nodiscard]] double Number(const TextRow& row, std::size_t column) const;
  // Decimal seconds, exact to the nanosecond also for times since 1970, which a double is not.
  [[nodiscard]] TimeNs Seconds(const TextRow& row, std::size_t column) const;
  [[noreturn]] void Fail(const TextRow& row, std::string_view what) const;

 private:
  std::filesystem::path path_;
  std::string text_;
  std::vector<TextRow> rows_;
};

// Parses decimal seconds such as "1326030975.736588" or "1.5e3". False when the word is not one, or beyond +-292 years.
bool ParseSeconds(std::string_view word, TimeNs* t);
// Parses a whole word as a number; "+1", "nan" and "inf" included. False when anything is left over.
bool ParseNumber(std::string_view word, double* value);
// Decimal seconds with nine digits after the point.
std::string FormatSeconds(TimeNs t);

}  // namespace mapweld::io
