// SPDX-License-Identifier: Apache-2.0
// Messages <-> bytes, with every field's range checked on the way out and on the way in. No heap.
//   Encode  gives the bytes written; kOutOfRange when a field is, kFull when `out` is too small.
//   Decode  kVersion: another message type or another version of it; kBadInput: the wrong number of bytes; kOutOfRange:
//   a
//           field is. *message is meaningful only after kOk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"
#include "drivers/messages/validate.hpp"

namespace mapweld::messages {

Result<std::size_t> Encode(const mapweldlcm::keyframe_t& message, std::span<std::uint8_t> out);
Result<std::size_t> Encode(const mapweldlcm::submap_chunk_t& message, std::span<std::uint8_t> out);
Result<std::size_t> Encode(const mapweldlcm::pose_t& message, std::span<std::uint8_t> out);
Result<std::size_t> Encode(const mapweldlcm::health_t& message, std::span<std::uint8_t> out);
Result<std::size_t> Encode(const mapweldlcm::global_pose_t& message, std::span<std::uint8_t> out);
Result<std::size_t> Encode(const mapweldlcm::request_t& message, std::span<std::uint8_t> out);
Result<std::size_t> Encode(const mapweldlcm::command_t& message, std::span<std::uint8_t> out);

Status Decode(std::span<const std::uint8_t> bytes, mapweldlcm::keyframe_t* message);
Status Decode(std::span<const std::uint8_t> bytes, mapweldlcm::submap_chunk_t* message);
Status Decode(std::span<const std::uint8_t> bytes, mapweldlcm::pose_t* message);
Status Decode(std::span<const std::uint8_t> bytes, mapweldlcm::health_t* message);
Status Decode(std::span<const std::uint8_t> bytes, mapweldlcm::global_pose_t* message);
Status Decode(std::span<const std::uint8_t> bytes, mapweldlcm::request_t* message);
Status Decode(std::span<const std::uint8_t> bytes, mapweldlcm::command_t* message);

}  // namespace mapweld::messages
