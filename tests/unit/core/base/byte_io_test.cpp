// SPDX-License-Identifier: Apache-2.0
#include "core/base/byte_io.hpp"

#include <gtest/gtest.h>

#include <array>

namespace mapweld {
namespace {

TEST(ByteReader, ReadsBothByteOrders) {
  const std::array<std::uint8_t, 6> bytes{0x12, 0x34, 0x56, 0x78, 0x9A, 0xBC};
  ByteReader reader(bytes);
  EXPECT_EQ(reader.Little<std::uint16_t>(), 0x3412);
  EXPECT_EQ(reader.Big<std::uint32_t>(), 0x56789ABCU);
  EXPECT_FALSE(reader.failed());
  EXPECT_EQ(reader.remaining(), 0U);
}

TEST(ByteReader, FailsPastTheEndAndStaysFailed) {
  const std::array<std::uint8_t, 3> bytes{1, 2, 3};
  ByteReader reader(bytes);
  EXPECT_EQ(reader.Little<std::uint32_t>(), 0U);
  EXPECT_TRUE(reader.failed());
  EXPECT_EQ(reader.Little<std::uint8_t>(), 1);  // nothing was consumed by the failed read
  EXPECT_TRUE(reader.failed());
}

TEST(ByteReader, ReadsNegativeNumbers) {
  const std::array<std::uint8_t, 2> bytes{0xFF, 0xFE};
  ByteReader reader(bytes);
  EXPECT_EQ(reader.Big<std::int16_t>(), -2);
}

TEST(ByteWriter, WritesWhatTheReaderReadsAndRefusesToOverflow) {
  std::array<std::uint8_t, 7> bytes{};
  ByteWriter writer(bytes);
  writer.Big<std::int16_t>(-5);
  writer.Little<std::uint32_t>(0xDEADBEEFU);
  EXPECT_FALSE(writer.failed());
  writer.Little<std::uint32_t>(1);
  EXPECT_TRUE(writer.failed());
  EXPECT_EQ(writer.size(), 6U);
  ByteReader reader(writer.written());
  EXPECT_EQ(reader.Big<std::int16_t>(), -5);
  EXPECT_EQ(reader.Little<std::uint32_t>(), 0xDEADBEEFU);
}

}  // namespace
}  // namespace mapweld
