// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/can_load.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/unit/drivers/can/dbc_text.hpp"

namespace mapweld::doctor {
namespace {

TEST(CanLoad, KnowsTheLengthOfAFrame) {
  // The figures of the standard's tables: 8 bytes take 111 to 135 bits with a short, 131 to 160 with a long identifier.
  EXPECT_EQ(LeastFrameBits({8, false}), 111);
  EXPECT_EQ(MostFrameBits({8, false}), 135);
  EXPECT_EQ(LeastFrameBits({8, true}), 131);
  EXPECT_EQ(MostFrameBits({8, true}), 160);
  EXPECT_EQ(LeastFrameBits({0, false}), 47);
  EXPECT_EQ(MostFrameBits({0, false}), 55);
}

TEST(CanLoad, OfAnXsensAt400HzFillsFourFifthsOfItsDefaultBus) {
  EXPECT_EQ(XsensMessages().size(), 5U);
  EXPECT_DOUBLE_EQ(MostLoad(XsensMessages(), 400), 198'000);
}

TEST(CanLoad, GrowsWithLongIdentifiers) {
  const auto messages = XsensMessages("00000005,00000006,00000011,00000032,00000034");
  EXPECT_DOUBLE_EQ(MostLoad(messages, 400), 248'000);
  EXPECT_THROW(XsensMessages("five"), std::runtime_error);
}

TEST(CanLoad, TakesEachMessageOfADatabaseOnce) {
  EXPECT_EQ(DbcMessages(can::test::kDbc, can::test::kMotorolaNames).size(), 2U);
  const auto intel = DbcMessages(can::test::kDbc, can::test::kIntelNames);
  ASSERT_EQ(intel.size(), 1U);
  EXPECT_TRUE(intel[0].extended);
  EXPECT_EQ(intel[0].data_bytes, 8);
  EXPECT_THROW(DbcMessages(can::test::kDbc, "gyroX,nothing"), std::runtime_error);
}

}  // namespace
}  // namespace mapweld::doctor
