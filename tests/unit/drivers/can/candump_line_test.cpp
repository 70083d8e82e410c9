// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/candump_line.hpp"

#include <gtest/gtest.h>

#include <string>

namespace mapweld::can {
namespace {

CanFrame MustParse(std::string_view line) {
  CanFrame frame;
  std::string_view interface;
  EXPECT_EQ(ParseCandumpLine(line, &frame, &interface), Status::kOk) << line;
  return frame;
}

Status TryParse(std::string_view line) {
  CanFrame frame;
  std::string_view interface;
  return ParseCandumpLine(line, &frame, &interface);
}

TEST(CandumpLine, GivesTimeInterfaceIdAndData) {
  CanFrame frame;
  std::string_view interface;
  ASSERT_EQ(ParseCandumpLine("(1436509052.249713) vcan0 034#00ff01A2", &frame, &interface), Status::kOk);
  EXPECT_EQ(interface, "vcan0");
  EXPECT_EQ(frame.receive.ns, 1'436'509'052'249'713'000);
  EXPECT_EQ(frame.id, 0x034U);
  EXPECT_EQ(frame.dlc, 4);
  EXPECT_EQ(frame.data[0], 0x00);
  EXPECT_EQ(frame.data[1], 0xFF);
  EXPECT_EQ(frame.data[3], 0xA2);
  EXPECT_TRUE(frame.stamped);
  EXPECT_FALSE(frame.extended || frame.remote || frame.error);
}

TEST(CandumpLine, TellsTheKindsOfFrameApart) {
  EXPECT_TRUE(MustParse("(0.000001) can0 00000123#11").extended);
  EXPECT_TRUE(MustParse("(0.000001) can0 123#R").remote);
  EXPECT_EQ(MustParse("(0.000001) can0 123#R8").dlc, 8);
  EXPECT_TRUE(MustParse("(0.000001) can0 20000040#0000000000000000").error);
  EXPECT_EQ(MustParse("(0.000001) can0 123#").dlc, 0);
}

TEST(CandumpLine, AcceptsShorterAndLongerFractionsAndTails) {
  EXPECT_EQ(MustParse("(1.5) can0 123#").receive.ns, 1'500'000'000);
  EXPECT_EQ(MustParse("(1.123456789) can0 123#").receive.ns, 1'123'456'789);
  EXPECT_EQ(MustParse("(1.5) can0 123#1122 R").dlc, 2);
  EXPECT_EQ(MustParse("(1.5)   can0\t123#1122\r").dlc, 2);
}

TEST(CandumpLine, RefusesWhatIsNotAFrame) {
  for (const char* line : {"",
                           "(",
                           "()",
                           "(1.5",
                           "(1.5)",
                           "(1.5) ",
                           "(1.5) can0",
                           "(1.5) can0 ",
                           "(1.5) can0 1",
                           "(1.5) can0 12#",
                           "(1.5) can0 123",
                           "(1.5) can0 1234#",
                           "(1.5) can0 800#",
                           "(1.5) can0 40000123#",
                           "(1.5) can0 123#1",
                           "(1.5) can0 123#112",
                           "(1.5) can0 123#0011223344556677889",
                           "(1.5) can0 123#001122334455667788",
                           "(1.5) can0 123#GG",
                           "(-1.5) can0 123#",
                           "(1) can0 123#",
                           "(.5) can0 123#",
                           "(1.1234567890) can0 123#",
                           "(99999999999.5) can0 123#",
                           "1.5 can0 123#",
                           "(1.5)can0 123#",
                           "(1.5) can0 123#R9",
                           "(1.5) can0 123#11R",
                           "(1.5) can0 123#11 X",
                           "(1.5) can0 123#11 RT"}) {
    EXPECT_EQ(TryParse(line), Status::kBadInput) << line;
  }
  EXPECT_EQ(TryParse("(1.5) can0 123##011"), Status::kVersion) << "CAN FD";
}

TEST(CandumpLine, SurvivesEveryTruncationAndEveryByte) {
  const std::string line = "(1436509052.249713) can0 034#00FF01020304";
  for (std::size_t n = 0; n < line.size(); ++n) (void)TryParse(std::string_view(line).substr(0, n));
  for (std::size_t at = 0; at < line.size(); ++at) {
    for (int byte = 0; byte < 256; ++byte) {
      std::string changed = line;
      changed[at] = static_cast<char>(byte);
      CanFrame frame;
      std::string_view interface;
      if (ParseCandumpLine(changed, &frame, &interface) != Status::kOk) continue;
      ASSERT_LE(frame.dlc, 8);
      ASSERT_GE(frame.receive.ns, 0);
    }
  }
}

}  // namespace
}  // namespace mapweld::can
