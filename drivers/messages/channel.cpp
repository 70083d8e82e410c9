// SPDX-License-Identifier: Apache-2.0
#include "drivers/messages/channel.hpp"

#include <algorithm>
#include <charconv>

namespace mapweld::messages {
namespace {

constexpr int kMaxAgentId = 32767;

}  // namespace

Result<std::string_view> FormatAgentPrefix(ChannelBuffer* buffer, int agent_id) {
  if (agent_id < 1 || agent_id > kMaxAgentId) return Status::kOutOfRange;
  char* at = std::copy(kChannelPrefix.begin(), kChannelPrefix.end(), buffer->data());
  at = std::to_chars(at, buffer->data() + buffer->size(), agent_id).ptr;
  *at++ = '.';
  *at = '\0';
  return std::string_view(buffer->data(), static_cast<std::size_t>(at - buffer->data()));
}

Result<std::string_view> FormatChannel(ChannelBuffer* buffer, int agent_id, Kind kind) {
  const Result<std::string_view> prefix = FormatAgentPrefix(buffer, agent_id);
  if (!prefix.ok()) return prefix.status();
  const std::string_view name = kKindNames[static_cast<std::size_t>(kind)];
  char* end = std::copy(name.begin(), name.end(), buffer->data() + prefix.value().size());
  *end = '\0';
  return std::string_view(buffer->data(), static_cast<std::size_t>(end - buffer->data()));
}

Result<Channel> ParseChannel(std::string_view name) {
  if (!name.starts_with(kChannelPrefix)) return Status::kBadInput;
  name.remove_prefix(kChannelPrefix.size());
  int agent_id = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), agent_id);
  if (error != std::errc{} || name.front() == '0' || agent_id < 1 || agent_id > kMaxAgentId) return Status::kBadInput;
  name.remove_prefix(static_cast<std::size_t>(end - name.data()));
  if (name.empty() || name.front() != '.') return Status::kBadInput;
  name.remove_prefix(1);
  const auto* kind = std::find(kKindNames.begin(), kKindNames.end(), name);
  if (kind == kKindNames.end()) return Status::kBadInput;
  return Channel{.agent_id = static_cast<std::int16_t>(agent_id), .kind = static_cast<Kind>(kind - kKindNames.begin())};
}

}  // namespace mapweld::messages
