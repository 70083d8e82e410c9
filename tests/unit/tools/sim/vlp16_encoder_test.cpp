// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/vlp16_encoder.hpp"

#include <gtest/gtest.h>

namespace mapweld::sim {
namespace {

TEST(Vlp16Encoder, PutsEveryByteWhereTheManualSays) {
  Vlp16Packet packet;
  packet.us_past_hour = 0x04030201;
  for (std::size_t block = 0; block < 12; ++block)
    packet.azimuth_cdeg[block] = static_cast<std::uint16_t>(0x1100 + block);
  for (std::size_t sequence = 0; sequence < 24; ++sequence) {
    for (std::size_t laser = 0; laser < 16; ++laser) {
      packet.returns[sequence][laser] = {static_cast<std::uint16_t>(256 * (sequence + 1) + laser),
                                         static_cast<std::uint8_t>(sequence * 4 + laser)};
    }
  }
  const auto bytes = EncodeVlp16(packet);
  ASSERT_EQ(bytes.size(), 1206U);
  for (std::size_t block = 0; block < 12; ++block) {
    const std::size_t at = block * 100;
    EXPECT_EQ(bytes[at], 0xFF);
    EXPECT_EQ(bytes[at + 1], 0xEE);
    EXPECT_EQ(bytes[at + 2], block);
    EXPECT_EQ(bytes[at + 3], 0x11);
    for (std::size_t channel = 0; channel < 32; ++channel) {
      const std::size_t sequence = block * 2 + channel / 16;
      EXPECT_EQ(bytes[at + 4 + channel * 3], channel % 16);
      EXPECT_EQ(bytes[at + 5 + channel * 3], sequence + 1);
      EXPECT_EQ(bytes[at + 6 + channel * 3], sequence * 4 + channel % 16);
    }
  }
  EXPECT_EQ(bytes[1200], 1);
  EXPECT_EQ(bytes[1203], 4);
  EXPECT_EQ(bytes[1204], 0x37);
  EXPECT_EQ(bytes[1205], 0x22);
}

TEST(Vlp16Encoder, KeepsTheSensorsPace) {
  EXPECT_EQ(Vlp16::kPacketPeriod_ns, 1'327'104);
  EXPECT_NEAR(1e9 / static_cast<double>(Vlp16::kPacketPeriod_ns), 753.5, 0.05);
}

}  // namespace
}  // namespace mapweld::sim
