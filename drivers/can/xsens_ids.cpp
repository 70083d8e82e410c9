// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/xsens_ids.hpp"

#include <algorithm>
#include <charconv>

namespace mapweld::can {
namespace {

constexpr std::array<XsensField, XsensIds::kCount> kFields{XsensField::kSampleTime, XsensField::kGroupCounter,
                                                           XsensField::kStatusWord, XsensField::kRateOfTurn,
                                                           XsensField::kAcceleration};

bool ParseId(std::string_view text, std::uint32_t* id) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *id, 16);
  if (error != std::errc{} || end != text.data() + text.size()) return false;
  const bool is_short = text.size() == 3 && *id <= 0x7FF;
  const bool is_long = text.size() == 8 && *id <= 0x1FFF'FFFF;
  if (is_long) *id |= XsensIds::kExtendedFlag;
  return is_short || is_long;
}

}  // namespace

XsensField XsensIds::FieldOf(const CanFrame& frame) const {
  const std::uint32_t id = frame.id | (frame.extended ? kExtendedFlag : 0U);
  for (std::size_t i = 0; i < kCount; ++i) {
    if (ids_[i] == id) return kFields[i];
  }
  return XsensField::kNone;
}

Status XsensIds::Parse(std::string_view text, XsensIds* ids) {
  XsensIds parsed;
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::size_t end = std::min(text.find(','), text.size());
    const auto before = parsed.ids_.begin() + static_cast<std::ptrdiff_t>(i);
    if ((end == text.size()) != (i + 1 == kCount) || !ParseId(text.substr(0, end), &parsed.ids_[i]) ||
        std::find(parsed.ids_.begin(), before, *before) != before) {
      return Status::kBadInput;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  *ids = parsed;
  return Status::kOk;
}

}  // namespace mapweld::can
