// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/candump_line.hpp"

#include <linux/can.h>

#include <cstddef>
#include <cstdint>

namespace mapweld::can {
namespace {

constexpr std::int64_t kMaxSeconds = 9'000'000'000;  // keeps nanoseconds within int64

int HexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

// Takes "(seconds.fraction)" off the front.
bool TakeTime(std::string_view* rest, TimeNs* t) {
  if (rest->empty() || rest->front() != '(') return false;
  rest->remove_prefix(1);
  std::int64_t seconds = 0;
  std::size_t digits = 0;
  while (digits < rest->size() && IsDigit((*rest)[digits])) {
    seconds = seconds * 10 + ((*rest)[digits++] - '0');
    if (seconds > kMaxSeconds) return false;
  }
  if (digits == 0 || digits >= rest->size() || (*rest)[digits] != '.') return false;
  rest->remove_prefix(digits + 1);
  std::int64_t fraction = 0;
  std::int64_t unit = 1'000'000'000;
  digits = 0;
  while (digits < rest->size() && IsDigit((*rest)[digits])) {
    if (unit == 1) return false;  // more than nine digits
    unit /= 10;
    fraction += ((*rest)[digits++] - '0') * unit;
  }
  if (digits == 0 || digits >= rest->size() || (*rest)[digits] != ')') return false;
  rest->remove_prefix(digits + 1);
  t->ns = seconds * 1'000'000'000 + fraction;
  return true;
}

bool TakeSpaces(std::string_view* rest) {
  std::size_t n = 0;
  while (n < rest->size() && ((*rest)[n] == ' ' || (*rest)[n] == '\t')) ++n;
  rest->remove_prefix(n);
  return n > 0;
}

bool TakeId(std::string_view* rest, CanFrame* frame) {
  std::uint32_t id = 0;
  std::size_t digits = 0;
  while (digits < rest->size() && digits < 8 && HexDigit((*rest)[digits]) >= 0) {
    id = (id << 4U) | static_cast<std::uint32_t>(HexDigit((*rest)[digits++]));
  }
  if (digits != 3 && digits != 8) return false;
  rest->remove_prefix(digits);
  frame->error = digits == 8 && (id & CAN_ERR_FLAG) != 0;
  frame->extended = digits == 8 && !frame->error;
  const std::uint32_t allowed = digits == 3 ? CAN_SFF_MASK : (CAN_EFF_MASK | CAN_ERR_FLAG);
  if ((id & ~allowed) != 0) return false;
  frame->id = id & CAN_EFF_MASK;
  return true;
}

bool TakeData(std::string_view* rest, CanFrame* frame) {
  if (!rest->empty() && rest->front() == 'R') {
    rest->remove_prefix(1);
    frame->remote = true;
    if (!rest->empty() && rest->front() >= '0' && rest->front() <= '8') {
      frame->dlc = static_cast<std::uint8_t>(rest->front() - '0');
      rest->remove_prefix(1);
    }
    return true;
  }
  while (rest->size() >= 2 && HexDigit((*rest)[0]) >= 0) {
    const int high = HexDigit((*rest)[0]);
    const int low = HexDigit((*rest)[1]);
    if (low < 0 || frame->dlc == frame->data.size()) return false;
    frame->data[frame->dlc++] = static_cast<std::uint8_t>(high * 16 + low);
    rest->remove_prefix(2);
  }
  return true;
}

// After the data: nothing, or the direction that newer versions of candump append.
bool IsTail(std::string_view rest) {
  (void)TakeSpaces(&rest);
  if (!rest.empty() && rest.back() == '\r') rest.remove_suffix(1);
  return rest.empty() || rest == "R" || rest == "T";
}

}  // namespace

Status ParseCandumpLine(std::string_view line, CanFrame* frame, std::string_view* interface) {
  *frame = {};
  frame->stamped = true;
  if (!TakeTime(&line, &frame->receive) || !TakeSpaces(&line)) return Status::kBadInput;
  const std::size_t name = line.find_first_of(" \t");
  if (name == std::string_view::npos || name == 0) return Status::kBadInput;
  *interface = line.substr(0, name);
  line.remove_prefix(name);
  (void)TakeSpaces(&line);
  if (!TakeId(&line, frame) || line.empty() || line.front() != '#') return Status::kBadInput;
  line.remove_prefix(1);
  if (!line.empty() && line.front() == '#') return Status::kVersion;
  if (!TakeData(&line, frame)) return Status::kBadInput;
  // A direction mark needs a space before it: "R" right after the data would be a stray character.
  if (!line.empty() && line.front() != ' ' && line.front() != '\t' && line.front() != '\r') return Status::kBadInput;
  return IsTail(line) ? Status::kOk : Status::kBadInput;
}

}  // namespace mapweld::can
