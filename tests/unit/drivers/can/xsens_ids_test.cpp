// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/xsens_ids.hpp"

#include <gtest/gtest.h>

#include "drivers/can/xsens_codec.hpp"
#include "tests/unit/drivers/can/xsens_frames.hpp"

namespace mapweld::can {
namespace {

TEST(XsensIds, ReadsShortAndLongIdentifiers) {
  XsensIds ids;
  EXPECT_EQ(ids.all(), kXsensWantedIds);
  ASSERT_EQ(XsensIds::Parse("7FF,00000006,011,1fffffff,034", &ids), Status::kOk);
  EXPECT_EQ(ids.all(), (std::array<std::uint32_t, 5>{0x7FF, 0x8000'0006, 0x011, 0x9FFF'FFFF, 0x034}));
}

TEST(XsensIds, RefusesWhatIsNoListOfFive) {
  XsensIds ids;
  for (const char* text :
       {"", "005", "005,006,011,032", "005,006,011,032,034,", "005,006,011,032,034,035", "005,006,011,032,032",
        "005,006,011,032,800", "005,006,011,032,20000000", "5,006,011,032,034", "0x5,006,011,032,034",
        "005,006,011,032,-34", "005,,011,032,034", "005 ,006,011,032,034"}) {
    EXPECT_EQ(XsensIds::Parse(text, &ids), Status::kBadInput) << text;
  }
  EXPECT_EQ(ids.all(), kXsensWantedIds);
}

// A short and a long identifier of the same number are two identifiers.
TEST(XsensIds, AreTakenByTheCodecInBothLengths) {
  for (const bool extended : {false, true}) {
    XsensIds ids;
    ASSERT_EQ(XsensIds::Parse(extended ? "00000105,00000106,00000111,00000132,00000134" : "105,106,111,132,134", &ids),
              Status::kOk);
    XsensCodec codec({.ids = ids});
    sensor::ImuSample sample;
    int samples = 0;
    for (const bool sent_extended : {!extended, extended}) {
      for (CanFrame frame : test::Group({.ticks = 1})) {
        frame.id += 0x100;
        frame.extended = sent_extended;
        samples += codec.Push(frame, &sample) == Status::kOk ? 1 : 0;
      }
      EXPECT_EQ(samples, sent_extended == extended ? 1 : 0);
    }
    EXPECT_EQ(codec.Rejected(), 5U) << "those of the other length";
  }
}

TEST(XsensIds, CountTheDevicesUsualMessagesAsUnusedWhenTheyHaveMoved) {
  XsensIds ids;
  ASSERT_EQ(XsensIds::Parse("105,106,111,132,134", &ids), Status::kOk);
  XsensCodec codec({.ids = ids});
  sensor::ImuSample sample;
  for (const CanFrame& frame : test::Group({.ticks = 1})) EXPECT_EQ(codec.Push(frame, &sample), Status::kEmpty);
  EXPECT_EQ(codec.counters().unused, 5U);
}

}  // namespace
}  // namespace mapweld::can
