// SPDX-License-Identifier: Apache-2.0
#include "tools/replay/can_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tools/sim/test_folder.hpp"
#include "tools/sim/candump.hpp"

namespace mapweld::replay {
namespace {

class CanLogFile : public testing::Test {
 protected:
  std::vector<can::CanFrame> Read(const std::string& text) {
    sim::WriteText(folder_ / "log", text);
    CanLog log(folder_ / "log");
    std::vector<can::CanFrame> frames;
    for (can::CanFrame frame; log.Next(&frame);) frames.push_back(frame);
    return frames;
  }
  const sim::TestFolder folder_;
};

TEST_F(CanLogFile, ReadsWhatTheSimulatorWrites) {
  const auto frames = Read(sim::CandumpLine(601'000'400'000, {0x032, 6, {1, 2, 3, 4, 5, 6}}) +
                           sim::CandumpLine(601'000'800'000, {0x006, 2, {0xFF, 0xFE}}));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].receive.ns, 601'000'400'000);
  EXPECT_EQ(frames[0].id, 0x032U);
  EXPECT_EQ(frames[0].dlc, 6);
  EXPECT_EQ(frames[0].data[5], 6);
  EXPECT_EQ(frames[1].data[0], 0xFF);
}

TEST_F(CanLogFile, LeavesOutWhatCannotBeSentAgain) {
  const auto frames = Read(
      "(1.000000) can0 032#R\n"
      "(1.000001) can0 20000040#0000000000000000\n"
      "(1.000002) can0 032##1AABB\n"
      "\n"
      "(1.000003) can0 18FEF100#01 R\n");
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_TRUE(frames[0].extended);
  EXPECT_EQ(frames[0].id, 0x18FEF100U);
}

TEST_F(CanLogFile, DropsALastLineThatBreaksOff) {
  EXPECT_EQ(Read("(1.000000) can0 032#0102\n(1.0000").size(), 1U);
}

TEST_F(CanLogFile, NamesTheLineThatIsNone) {
  const std::string message = sim::MessageOf([this] { (void)Read("(1.0) can0 032#01\ncan0 032 [2] 01 02\n"); });
  EXPECT_THAT(message, testing::HasSubstr("log, line 2: 'can0 032 [2] 01 02'"));
  EXPECT_THAT(sim::MessageOf([] { CanLog log("nowhere.candump"); }), testing::HasSubstr("nowhere.candump"));
}

}  // namespace
}  // namespace mapweld::replay
