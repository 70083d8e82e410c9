// SPDX-License-Identifier: Apache-2.0
#include "drivers/bus/udpm_wire.hpp"

#include <gtest/gtest.h>

#include "tests/unit/drivers/bus/datagrams.hpp"

namespace mapweld::bus {
namespace {

using test::Bytes;

TEST(UdpmWire, EncodesAShortMessageAsTheProtocolSays) {
  Bytes out(64);
  const Result<std::size_t> bytes = EncodeShortHeader(0x01020304, "MW.3.POSE", out);
  ASSERT_TRUE(bytes.ok());
  out.resize(bytes.value());
  EXPECT_EQ(out, test::Short(0x01020304, "MW.3.POSE", {}));
}

TEST(UdpmWire, ParsesWhatItEncodes) {
  const Bytes payload = test::Pattern(100);
  const Bytes datagram = test::Short(77, "MW.3.POSE", payload);
  ParsedDatagram parsed;
  ASSERT_EQ(ParseDatagram(datagram, &parsed), Refusal::kNone);
  EXPECT_FALSE(parsed.fragment);
  EXPECT_EQ(parsed.sequence, 77U);
  EXPECT_EQ(parsed.channel, "MW.3.POSE");
  EXPECT_TRUE(std::equal(payload.begin(), payload.end(), parsed.payload.begin(), parsed.payload.end()));
}

TEST(UdpmWire, AcceptsAnEmptyPayloadAndTheLongestChannel) {
  ParsedDatagram parsed;
  ASSERT_EQ(ParseDatagram(test::Short(0, std::string(63, 'x'), {}), &parsed), Refusal::kNone);
  EXPECT_EQ(parsed.channel.size(), 63U);
  EXPECT_TRUE(parsed.payload.empty());
}

TEST(UdpmWire, RefusesChannelsThatCannotTravel) {
  Bytes out(128);
  EXPECT_EQ(EncodeShortHeader(0, "", out).status(), Status::kOutOfRange);
  EXPECT_EQ(EncodeShortHeader(0, std::string(64, 'x'), out).status(), Status::kOutOfRange);
  EXPECT_EQ(EncodeShortHeader(0, std::string_view("a\0b", 3), out).status(), Status::kOutOfRange);
  EXPECT_EQ(EncodeShortHeader(0, "abc", std::span(out).first(11)).status(), Status::kFull);
}

TEST(UdpmWire, RefusesEachBadDatagramForItsReason) {
  const auto refusal = [](const Bytes& datagram) {
    ParsedDatagram parsed;
    return ParseDatagram(datagram, &parsed);
  };
  EXPECT_EQ(refusal({}), Refusal::kTooShort);
  EXPECT_EQ(refusal(Bytes(8, 0)), Refusal::kMagic);
  EXPECT_EQ(refusal(test::Short(1, "", {})), Refusal::kChannel);
  EXPECT_EQ(refusal(test::Short(1, std::string(64, 'x'), {})), Refusal::kChannel);
  Bytes cut = test::Fragment({.size = 10, .count = 1}, test::Pattern(10));
  cut.resize(19);
  EXPECT_EQ(refusal(cut), Refusal::kTooShort);
  EXPECT_EQ(refusal(test::Fragment({.size = 10, .count = 0}, test::Pattern(10))), Refusal::kFragment);
  EXPECT_EQ(refusal(test::Fragment({.size = 10, .number = 1, .count = 1}, test::Pattern(10))), Refusal::kFragment);
  EXPECT_EQ(refusal(test::Fragment({.size = 9, .count = 1}, test::Pattern(10))), Refusal::kFragment);
  EXPECT_EQ(refusal(test::Fragment({.size = 10, .count = 1}, {})), Refusal::kFragment);
  EXPECT_EQ(refusal(test::Fragment({.size = 10, .offset = 0, .number = 1, .count = 2}, test::Pattern(5))),
            Refusal::kFragment)
      << "only the first piece is at 0";
  EXPECT_EQ(refusal(test::Fragment({.size = 64, .offset = 0xFFFFFFF0, .number = 1, .count = 2}, test::Pattern(32))),
            Refusal::kFragment)
      << "no wrap around";
}

TEST(UdpmWire, SurvivesEveryTruncationAndBitFlip) {
  for (const Bytes& good : {test::Short(3, "MW.1.REQUEST", test::Pattern(30)),
                            test::Fragment({.size = 60, .number = 0, .count = 2}, test::Pattern(30)),
                            test::Fragment({.size = 60, .offset = 30, .number = 1, .count = 2}, test::Pattern(30))}) {
    ParsedDatagram parsed;
    for (std::size_t n = 0; n <= good.size(); ++n) {
      const Bytes exact(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n));  // so that ASan sees the end
      (void)ParseDatagram(exact, &parsed);
    }
    for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
      Bytes flipped = good;
      flipped[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
      if (ParseDatagram(flipped, &parsed) != Refusal::kNone) continue;
      ASSERT_LE(parsed.channel.size(), kMaxChannelBytes);
      ASSERT_TRUE(!parsed.fragment || parsed.offset + parsed.payload.size() <= parsed.message_bytes);
    }
  }
}

}  // namespace
}  // namespace mapweld::bus
