// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace mapweld::spy {

// By the 8-byte fingerprint that begins every LCM payload: "pose_t" for ours, "0x0123456789abcdef" for others, "-" when
// the payload is too short to have one.
std::string TypeName(std::span<const std::uint8_t> payload);

// false for a message on a channel of ours that agents and host refuse: another type or version, a field out of range.
bool AgentsWouldTake(std::string_view channel, std::span<const std::uint8_t> payload);

}  // namespace mapweld::spy
