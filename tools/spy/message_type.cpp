// SPDX-License-Identifier: Apache-2.0
#include "tools/spy/message_type.hpp"

#include <fmt/format.h>

#include "core/base/byte_io.hpp"
#include "drivers/messages/channel.hpp"
#include "drivers/messages/codec.hpp"

namespace mapweld::spy {
namespace {

template <class... Messages>
std::string NameAmong(std::int64_t fingerprint) {
  std::string name = fmt::format("{:#018x}", static_cast<std::uint64_t>(fingerprint));
  ((fingerprint == Messages::getHash() ? void(name = Messages::getTypeName()) : void()), ...);
  return name;
}

template <class Message>
bool Decodes(std::span<const std::uint8_t> payload) {
  Message message;
  return messages::Decode(payload, &message) == Status::kOk;
}

}  // namespace

std::string TypeName(std::span<const std::uint8_t> payload) {
  ByteReader reader(payload);
  const auto fingerprint = reader.Big<std::int64_t>();
  if (reader.failed()) return "-";
  return NameAmong<mapweldlcm::keyframe_t, mapweldlcm::submap_chunk_t, mapweldlcm::pose_t, mapweldlcm::health_t,
                   mapweldlcm::global_pose_t, mapweldlcm::request_t, mapweldlcm::command_t>(fingerprint);
}

bool AgentsWouldTake(std::string_view channel, std::span<const std::uint8_t> payload) {
  const auto parsed = messages::ParseChannel(channel);
  if (!parsed.ok()) return true;  // not ours
  switch (parsed.value().kind) {
    case messages::Kind::kKeyframe:
      return Decodes<mapweldlcm::keyframe_t>(payload);
    case messages::Kind::kSubmapChunk:
      return Decodes<mapweldlcm::submap_chunk_t>(payload);
    case messages::Kind::kPose:
      return Decodes<mapweldlcm::pose_t>(payload);
    case messages::Kind::kHealth:
      return Decodes<mapweldlcm::health_t>(payload);
    case messages::Kind::kGlobalPose:
      return Decodes<mapweldlcm::global_pose_t>(payload);
    case messages::Kind::kRequest:
      return Decodes<mapweldlcm::request_t>(payload);
    case messages::Kind::kCommand:
      return Decodes<mapweldlcm::command_t>(payload);
  }
  return false;
}

}  // namespace mapweld::spy
