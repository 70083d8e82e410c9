// SPDX-License-Identifier: Apache-2.0
#include "drivers/messages/codec.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/config/capacity.hpp"
#include "tests/support/sample_messages.hpp"

namespace mapweld::messages {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <class T>
Bytes MustEncode(const T& message) {
  Bytes out(4096);
  const Result<std::size_t> bytes = Encode(message, out);
  EXPECT_TRUE(bytes.ok());
  if (bytes.ok()) out.resize(bytes.value());
  return out;
}

template <class T>
Bytes EncodeByLcmGen(const T& message) {
  Bytes out(static_cast<std::size_t>(message.getEncodedSize()));
  EXPECT_EQ(message.encode(out.data(), 0, static_cast<int>(out.size())), static_cast<int>(out.size()));
  return out;
}

template <class T>
class MessageCodec : public testing::Test {};

using Types =
    testing::Types<mapweldlcm::keyframe_t, mapweldlcm::submap_chunk_t, mapweldlcm::pose_t, mapweldlcm::health_t,
                   mapweldlcm::global_pose_t, mapweldlcm::request_t, mapweldlcm::command_t>;
TYPED_TEST_SUITE(MessageCodec, Types);

TYPED_TEST(MessageCodec, RoundTripsToTheSameBytes) {
  const TypeParam message = test::SampleMessage<TypeParam>();
  const Bytes bytes = MustEncode(message);
  EXPECT_EQ(bytes, EncodeByLcmGen(message));
  TypeParam decoded{};
  ASSERT_EQ(Decode(bytes, &decoded), Status::kOk);
  EXPECT_EQ(MustEncode(decoded), bytes);
}

TYPED_TEST(MessageCodec, FitsOneDatagram) {
  EXPECT_LE(MustEncode(test::SampleMessage<TypeParam>()).size(), kCap.datagram_bytes);
}

TYPED_TEST(MessageCodec, RefusesEveryTruncationAndExtension) {
  Bytes bytes = MustEncode(test::SampleMessage<TypeParam>());
  TypeParam decoded{};
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const Bytes exact(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    ASSERT_EQ(Decode(exact, &decoded), Status::kBadInput) << n;
  }
  bytes.push_back(0);
  EXPECT_EQ(Decode(bytes, &decoded), Status::kBadInput);
}

TYPED_TEST(MessageCodec, SurvivesEveryBitFlipWithoutAnInvalidMessage) {
  const Bytes bytes = MustEncode(test::SampleMessage<TypeParam>());
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    Bytes flipped = bytes;
    flipped[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    TypeParam decoded{};
    const Status status = Decode(flipped, &decoded);
    if (bit < 64) {
      ASSERT_EQ(status, Status::kVersion);
    }
    if (status != Status::kOk) continue;
    ASSERT_EQ(Validate(decoded), Status::kOk);
    ASSERT_EQ(MustEncode(decoded), flipped);
  }
}

TYPED_TEST(MessageCodec, NamesAnotherTypeAsSuch) {
  const Bytes command = MustEncode(test::SampleMessage<mapweldlcm::command_t>());
  const Bytes request = MustEncode(test::SampleMessage<mapweldlcm::request_t>());
  TypeParam decoded{};
  const bool is_command = std::is_same_v<TypeParam, mapweldlcm::command_t>;
  EXPECT_EQ(Decode(is_command ? request : command, &decoded), Status::kVersion);
}

TYPED_TEST(MessageCodec, SaysWhenTheBufferIsTooSmall) {
  const TypeParam message = test::SampleMessage<TypeParam>();
  Bytes out(MustEncode(message).size() - 1);
  EXPECT_EQ(Encode(message, out).status(), Status::kFull);
}

TYPED_TEST(MessageCodec, DoesNotSendWhatItWouldNotAccept) {
  TypeParam message = test::SampleMessage<TypeParam>();
  message.agent_id = 0;
  Bytes out(4096);
  EXPECT_EQ(Encode(message, out).status(), Status::kOutOfRange);
  TypeParam decoded{};
  EXPECT_EQ(Decode(EncodeByLcmGen(message), &decoded), Status::kOutOfRange);
}

}  // namespace
}  // namespace mapweld::messages
