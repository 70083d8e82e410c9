// SPDX-License-Identifier: Apache-2.0
// LCM channel names: MW.<agent>.<TYPE>, for example MW.3.KEYFRAME. The agent is the one that the message is from or,
// for requests, global poses and commands, the one that it is for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/status.hpp"

namespace mapweld::messages {

enum class Kind : std::uint8_t { kKeyframe, kSubmapChunk, kPose, kHealth, kGlobalPose, kRequest, kCommand };

inline constexpr std::array<std::string_view, 7> kKindNames{"KEYFRAME",    "SUBMAP_CHUNK", "POSE",   "HEALTH",
                                                            "GLOBAL_POSE", "REQUEST",      "COMMAND"};
inline constexpr std::string_view kChannelPrefix = "MW.";

// Room for every channel name and a terminating NUL.
using ChannelBuffer = std::array<char, 32>;

// Writes the name into `buffer`, NUL-terminated; the view is into it. kOutOfRange unless 1 <= agent_id <= 32767.
Result<std::string_view> FormatChannel(ChannelBuffer* buffer, int agent_id, Kind kind);

// "MW.3.": everything of one agent.
Result<std::string_view> FormatAgentPrefix(ChannelBuffer* buffer, int agent_id);

struct Channel {
  std::int16_t agent_id = 0;
  Kind kind = Kind::kKeyframe;
};
// kBadInput for anything that FormatChannel does not write.
Result<Channel> ParseChannel(std::string_view name);

}  // namespace mapweld::messages
