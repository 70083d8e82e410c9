// SPDX-License-Identifier: Apache-2.0
// First byte: the type, and in its highest bit whether the type's fingerprint is put in place. The rest: the message.
#include <algorithm>

#include "core/base/byte_io.hpp"
#include "drivers/messages/codec.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/support/sample_messages.hpp"

namespace mapweld::fuzz {
namespace {

template <class T>
Bytes Seed(std::uint8_t type) {
  Bytes out(4096);
  out[0] = type;
  const Result<std::size_t> bytes = messages::Encode(test::SampleMessage<T>(), std::span(out).subspan(1));
  FUZZ_REQUIRE(bytes.ok());
  out.resize(1 + bytes.value());
  return out;
}

template <class T>
void RunAs(Bytes bytes, bool patch) {
  if (patch && bytes.size() >= 8) ByteWriter(std::span(bytes).first(8)).Big(T::getHash());
  T message;
  if (messages::Decode(bytes, &message) != Status::kOk) return;
  FUZZ_REQUIRE(messages::Validate(message) == Status::kOk);
  Bytes again(bytes.size());
  const Result<std::size_t> encoded = messages::Encode(message, again);
  FUZZ_REQUIRE(encoded.ok() && encoded.value() == bytes.size() && again == bytes);
}

}  // namespace

std::vector<Bytes> Seeds() {
  return {Seed<mapweldlcm::keyframe_t>(0),     Seed<mapweldlcm::submap_chunk_t>(1), Seed<mapweldlcm::pose_t>(2),
          Seed<mapweldlcm::health_t>(3),       Seed<mapweldlcm::global_pose_t>(4),  Seed<mapweldlcm::request_t>(5),
          Seed<mapweldlcm::command_t>(6 | 128)};
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld::fuzz;
  Input input(data, size);
  const auto selector = static_cast<unsigned>(input.Number(1));
  const bool patch = (selector & 128U) != 0;
  switch ((selector & 127U) % 7) {
    case 0:
      RunAs<mapweldlcm::keyframe_t>(input.Rest(), patch);
      break;
    case 1:
      RunAs<mapweldlcm::submap_chunk_t>(input.Rest(), patch);
      break;
    case 2:
      RunAs<mapweldlcm::pose_t>(input.Rest(), patch);
      break;
    case 3:
      RunAs<mapweldlcm::health_t>(input.Rest(), patch);
      break;
    case 4:
      RunAs<mapweldlcm::global_pose_t>(input.Rest(), patch);
      break;
    case 5:
      RunAs<mapweldlcm::request_t>(input.Rest(), patch);
      break;
    default:
      RunAs<mapweldlcm::command_t>(input.Rest(), patch);
  }
  return 0;
}
