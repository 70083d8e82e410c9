// SPDX-License-Identifier: Apache-2.0
// The agent's mouth: its results as LCM messages.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/pipeline/agent_pipeline.hpp"
#include "drivers/bus/udpm_bus.hpp"
#include "drivers/messages/channel.hpp"
#include "drivers/messages/codec.hpp"

namespace mapweld::executive {

// Who speaks: fixed at boot.
struct Identity {
  std::int16_t agent_id = 0;
  std::int32_t epoch = 0;
};

// Encodes into one fixed buffer and publishes at once. What the bus refuses is counted there. No heap.
class Telemetry {
 public:
  Telemetry(const Identity& identity, bus::UdpmBus* bus) : identity_(identity), bus_(bus) {}

  void PublishPose(const pipeline::PoseOutput& pose);
  // Gives the encoded message, valid until the next call, so that it can be spooled; empty when a field is out of
  // range.
  std::span<const std::uint8_t> PublishKeyframe(const pipeline::KeyframeOutput& keyframe);
  // health.agent_id and epoch are filled in here.
  void PublishHealth(mapweldlcm::health_t* health);
  // One piece of an encoded submap, of this boot or an earlier one, at most kChunkBytes from `offset` on. Gives the
  // payload bytes sent.
  static constexpr std::size_t kChunkBytes = 1280;
  std::size_t PublishSubmapChunk(std::int32_t epoch, std::int32_t keyframe, std::span<const std::uint8_t> submap,
                                 std::size_t offset);
  // A keyframe_t as it was encoded the first time.
  void RepeatKeyframe(std::span<const std::uint8_t> encoded) { Send(messages::Kind::kKeyframe, encoded); }

  [[nodiscard]] const Identity& identity() const { return identity_; }

 private:
  template <class Message>
  std::span<const std::uint8_t> Publish(messages::Kind kind, const Message& message) {
    const Result<std::size_t> bytes = messages::Encode(message, buffer_);
    if (!bytes.ok()) return {};
    const std::span<const std::uint8_t> encoded{buffer_.data(), bytes.value()};
    Send(kind, encoded);
    return encoded;
  }
  void Send(messages::Kind kind, std::span<const std::uint8_t> encoded);

  Identity identity_;
  bus::UdpmBus* bus_;
  std::array<std::uint8_t, 2048> buffer_{};
  mapweldlcm::keyframe_t keyframe_{};
  mapweldlcm::submap_chunk_t chunk_{};
};

}  // namespace mapweld::executive
