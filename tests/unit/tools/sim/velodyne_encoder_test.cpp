// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/velodyne_encoder.hpp"

#include <gtest/gtest.h>

namespace mapweld::sim {
namespace {

TEST(VelodyneEncoder, PutsEveryByteWhereTheManualSays) {
  VelodynePacket packet;
  packet.us_past_hour = 0x04030201;
  for (std::size_t block = 0; block < 12; ++block) {
    packet.azimuth_cdeg[block] = static_cast<std::uint16_t>(0x1100 + block);
    for (std::size_t channel = 0; channel < 32; ++channel) {
      packet.returns[block][channel] = {static_cast<std::uint16_t>(256 * (block + 1) + channel),
                                        static_cast<std::uint8_t>(block * 4 + channel)};
    }
  }
  const auto bytes = EncodeVelodyne(packet);
  ASSERT_EQ(bytes.size(), 1206U);
  for (std::size_t block = 0; block < 12; ++block) {
    const std::size_t at = block * 100;
    EXPECT_EQ(bytes[at], 0xFF);
    EXPECT_EQ(bytes[at + 1], 0xEE);
    EXPECT_EQ(bytes[at + 2], block);
    EXPECT_EQ(bytes[at + 3], 0x11);
    for (std::size_t channel = 0; channel < 32; ++channel) {
      EXPECT_EQ(bytes[at + 4 + channel * 3], channel);
      EXPECT_EQ(bytes[at + 5 + channel * 3], block + 1);
      EXPECT_EQ(bytes[at + 6 + channel * 3], block * 4 + channel);
    }
  }
  EXPECT_EQ(bytes[1200], 1);
  EXPECT_EQ(bytes[1203], 4);
  EXPECT_EQ(bytes[1204], 0x37);
  EXPECT_EQ(bytes[1205], 0x22);
  packet.mode = VelodynePacket::kDualReturn;
  EXPECT_EQ(EncodeVelodyne(packet)[1204], 0x39);
  packet.model = VelodynePacket::kHdl32e;
  EXPECT_EQ(EncodeVelodyne(packet)[1205], 0x21);
}

TEST(VelodyneEncoder, KeepsTheSensorsPace) {
  const LidarModel vlp16 = LidarByName("vlp16");
  EXPECT_EQ(vlp16.ColumnStart_ns(VelodyneColumns(vlp16)), 1'327'104);
  const LidarModel hdl32e = LidarByName("hdl32e");
  EXPECT_EQ(hdl32e.ColumnStart_ns(VelodyneColumns(hdl32e)), 552'960);
  EXPECT_EQ(vlp16.ColumnStart_ns(VelodyneColumns(vlp16, true)), 663'552) << "twice as many packets";
  EXPECT_EQ(VelodyneColumns(LidarByName("hdl64e")), 0) << "no packets of this one";
}

}  // namespace
}  // namespace mapweld::sim
