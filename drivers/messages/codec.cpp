// SPDX-License-Identifier: Apache-2.0
#include "drivers/messages/codec.hpp"

#include "core/base/byte_io.hpp"

namespace mapweld::messages {
namespace {

template <class T>
Result<std::size_t> EncodeChecked(const T& message, std::span<std::uint8_t> out) {
  if (const Status status = Validate(message); status != Status::kOk) return status;
  const int bytes = message.getEncodedSize();
  if (out.size() < static_cast<std::size_t>(bytes)) return Status::kFull;
  if (message.encode(out.data(), 0, bytes) != bytes) return Status::kFull;
  return static_cast<std::size_t>(bytes);
}

template <class T>
Status DecodeChecked(std::span<const std::uint8_t> bytes, T* message) {
  ByteReader reader(bytes);
  const auto type = reader.Big<std::int64_t>();
  if (reader.failed()) return Status::kBadInput;
  if (type != T::getHash()) return Status::kVersion;
  // All types have a fixed size, so that it can be compared before anything is read.
  const int expected = message->getEncodedSize();
  if (bytes.size() != static_cast<std::size_t>(expected)) return Status::kBadInput;
  if (message->decode(bytes.data(), 0, expected) != expected) return Status::kBadInput;
  return Validate(*message);
}

}  // namespace

Result<std::size_t> Encode(const mapweldlcm::keyframe_t& m, std::span<std::uint8_t> out) {
  return EncodeChecked(m, out);
}
Result<std::size_t> Encode(const mapweldlcm::submap_chunk_t& m, std::span<std::uint8_t> out) {
  return EncodeChecked(m, out);
}
Result<std::size_t> Encode(const mapweldlcm::pose_t& m, std::span<std::uint8_t> out) {
  return EncodeChecked(m, out);
}
Result<std::size_t> Encode(const mapweldlcm::health_t& m, std::span<std::uint8_t> out) {
  return EncodeChecked(m, out);
}
Result<std::size_t> Encode(const mapweldlcm::global_pose_t& m, std::span<std::uint8_t> out) {
  return EncodeChecked(m, out);
}
Result<std::size_t> Encode(const mapweldlcm::request_t& m, std::span<std::uint8_t> out) {
  return EncodeChecked(m, out);
}
Result<std::size_t> Encode(const mapweldlcm::command_t& m, std::span<std::uint8_t> out) {
  return EncodeChecked(m, out);
}

Status Decode(std::span<const std::uint8_t> bytes, mapweldlcm::keyframe_t* m) {
  return DecodeChecked(bytes, m);
}
Status Decode(std::span<const std::uint8_t> bytes, mapweldlcm::submap_chunk_t* m) {
  return DecodeChecked(bytes, m);
}
Status Decode(std::span<const std::uint8_t> bytes, mapweldlcm::pose_t* m) {
  return DecodeChecked(bytes, m);
}
Status Decode(std::span<const std::uint8_t> bytes, mapweldlcm::health_t* m) {
  return DecodeChecked(bytes, m);
}
Status Decode(std::span<const std::uint8_t> bytes, mapweldlcm::global_pose_t* m) {
  return DecodeChecked(bytes, m);
}
Status Decode(std::span<const std::uint8_t> bytes, mapweldlcm::request_t* m) {
  return DecodeChecked(bytes, m);
}
Status Decode(std::span<const std::uint8_t> bytes, mapweldlcm::command_t* m) {
  return DecodeChecked(bytes, m);
}

}  // namespace mapweld::messages
