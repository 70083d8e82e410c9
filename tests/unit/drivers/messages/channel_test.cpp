// SPDX-License-Identifier: Apache-2.0
#include "drivers/messages/channel.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace mapweld::messages {
namespace {

TEST(ChannelName, IsMwAgentType) {
  ChannelBuffer buffer;
  EXPECT_EQ(FormatChannel(&buffer, 3, Kind::kKeyframe).value(), "MW.3.KEYFRAME");
  EXPECT_EQ(std::strlen(buffer.data()), 13U) << "also a C string";
  EXPECT_EQ(FormatChannel(&buffer, 32767, Kind::kSubmapChunk).value(), "MW.32767.SUBMAP_CHUNK");
  EXPECT_EQ(FormatAgentPrefix(&buffer, 12).value(), "MW.12.");
}

TEST(ChannelName, RoundTripsForEveryAgentAndKind) {
  ChannelBuffer buffer;
  for (int agent = 1; agent <= 32767; ++agent) {
    for (std::size_t kind = 0; kind < kKindNames.size(); ++kind) {
      const auto name = FormatChannel(&buffer, agent, static_cast<Kind>(kind));
      ASSERT_TRUE(name.ok());
      const auto parsed = ParseChannel(name.value());
      ASSERT_TRUE(parsed.ok()) << name.value();
      ASSERT_EQ(parsed.value().agent_id, agent);
      ASSERT_EQ(parsed.value().kind, static_cast<Kind>(kind));
    }
  }
}

TEST(ChannelName, HasOneSpelling) {
  for (const char* name : {"", "MW", "MW.", "MW.3", "MW.3.", "MW..POSE", "MW.0.POSE", "MW.03.POSE", "MW.+3.POSE",
                           "MW.-3.POSE", "MW.32768.POSE", "MW.99999999999.POSE", "MW.3.POSES", "MW.3.pose", "mw.3.POSE",
                           "MW.3.POSE ", " MW.3.POSE", "MW.3POSE", "MW.3..POSE"}) {
    EXPECT_EQ(ParseChannel(name).status(), Status::kBadInput) << name;
  }
}

TEST(ChannelName, NeedsAnAgentIdInRange) {
  ChannelBuffer buffer;
  for (const int agent : {-1, 0, 32768, 1 << 30}) {
    EXPECT_EQ(FormatChannel(&buffer, agent, Kind::kPose).status(), Status::kOutOfRange);
  }
}

}  // namespace
}  // namespace mapweld::messages
