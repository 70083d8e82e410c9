// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/dbc_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace mapweld::can {
namespace {

constexpr std::string_view kBlank = " \t\r";

// Takes what a line of the file is made of off its front.
class Line {
 public:
  explicit Line(std::string_view text) : rest_(text) {}

  bool Literal(std::string_view literal) {
    SkipBlank();
    if (!rest_.starts_with(literal)) return false;
    rest_.remove_prefix(literal.size());
    return true;
  }
  std::string_view Word() {
    SkipBlank();
    const std::size_t end = std::min(rest_.find_first_of(" \t\r:"), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }
  template <class T>
  bool Number(T* value) {
    SkipBlank();
    if (rest_.starts_with('+')) rest_.remove_prefix(1);
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), *value);
    if (error != std::errc{}) return false;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return true;
  }
  bool Quoted(std::string_view* text) {
    if (!Literal("\"")) return false;
    const std::size_t end = rest_.find('"');
    if (end == std::string_view::npos) return false;
    *text = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return true;
  }

 private:
  void SkipBlank() { rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlank), rest_.size())); }
  std::string_view rest_;
};

// BO_ 2566844926 Name: 8 Node
bool ReadMessage(Line line, DbcSignal* signal) {
  constexpr std::uint32_t kExtendedFlag = 0x80000000;
  std::uint32_t id = 0;
  if (!line.Literal("BO_ ") || !line.Number(&id)) return false;
  (void)line.Word();
  if (!line.Literal(":") || !line.Number(&signal->dlc)) return false;
  signal->extended = (id & kExtendedFlag) != 0;
  signal->id = id & ~kExtendedFlag;
  return signal->dlc >= 1 && signal->dlc <= 8 && signal->id <= (signal->extended ? 0x1FFFFFFFU : 0x7FFU);
}

// The bit numbers of a Motorola signal run down within a byte and on to the next byte: counted so, from the highest bit
// of the first byte, its bits are neighbours.
unsigned FirstBit(const DbcSignal& signal) {
  return signal.big_endian ? signal.start / 8U * 8U + (7U - signal.start % 8U) : signal.start;
}

// ` : 7|16@0- (0.001953125,0) [-64|64] "rad/s" Node`
bool ReadSignal(Line line, DbcSignal* signal) {
  unsigned byte_order = 0;
  double low = 0;
  double high = 0;
  if (!line.Literal(":") || !line.Number(&signal->start) || !line.Literal("|") || !line.Number(&signal->length) ||
      !line.Literal("@") || !line.Number(&byte_order)) {
    return false;
  }
  signal->is_signed = line.Literal("-");
  if (byte_order > 1 || (!signal->is_signed && !line.Literal("+"))) return false;
  signal->big_endian = byte_order == 0;
  const bool scaled = line.Literal("(") && line.Number(&signal->factor) && line.Literal(",") &&
                      line.Number(&signal->offset) && line.Literal(")") && line.Literal("[") && line.Number(&low) &&
                      line.Literal("|") && line.Number(&high) && line.Literal("]") && line.Quoted(&signal->unit);
  return scaled && std::isfinite(signal->factor) && std::isfinite(signal->offset) && signal->length >= 1 &&
         signal->length <= 32 && FirstBit(*signal) + signal->length <= 8U * signal->dlc;
}

}  // namespace

Status FindDbcSignal(std::string_view dbc, std::string_view name, DbcSignal* signal) {
  DbcSignal message;
  bool in_message = false;
  bool found = false;
  while (!dbc.empty()) {
    const std::size_t end = std::min(dbc.find('\n'), dbc.size());
    const std::string_view text = dbc.substr(0, end);
    dbc.remove_prefix(std::min(end + 1, dbc.size()));
    Line line(text);
    if (line.Literal("BO_ ")) {
      message = {};
      in_message = ReadMessage(Line(text), &message);
    } else if (line.Literal("SG_ ") && line.Word() == name) {
      if (found) return Status::kEmpty;
      if (!in_message || !ReadSignal(line, &message)) return Status::kBadInput;
      *signal = message;
      found = true;
    }
  }
  return found ? Status::kOk : Status::kEmpty;
}

double DbcValue(const DbcSignal& signal, const CanFrame& frame) {
  std::uint64_t bits = 0;  // the frame as one number, so that the signal's bits are neighbours
  for (std::size_t i = 0; i < frame.data.size(); ++i) {
    const std::size_t shift = signal.big_endian ? 8 * (7 - i) : 8 * i;
    bits |= std::uint64_t{frame.data[i]} << shift;
  }
  const unsigned first = FirstBit(signal);
  const unsigned shift = signal.big_endian ? 64 - first - signal.length : first;
  const std::uint64_t raw = (bits >> shift) & ((std::uint64_t{1} << signal.length) - 1);
  const bool negative = signal.is_signed && (raw >> (signal.length - 1U)) != 0;
  const auto value = static_cast<double>(raw) - (negative ? std::ldexp(1.0, signal.length) : 0.0);
  return value * signal.factor + signal.offset;
}

}  // namespace mapweld::can
