// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/presence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mapweld::serve {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

const Presence::Clock::time_point kStart{1000s};

TEST(Presence, AnAgentIsHereUntilItHasBeenSilentForAWhile) {
  Presence presence;
  EXPECT_FALSE(presence.IsHere({3, 1}, kStart));
  presence.Heard({3, 1}, kStart);
  EXPECT_TRUE(presence.IsHere({3, 1}, kStart + Presence::kSilence));
  EXPECT_FALSE(presence.IsHere({3, 1}, kStart + Presence::kSilence + 1ms));
  presence.Heard({3, 1}, kStart + 1h);
  EXPECT_TRUE(presence.IsHere({3, 1}, kStart + 1h)) << "it has returned";
}

TEST(Presence, ARestartedAgentIsAskedForItsEarlierDriveWhileItSpeaks) {
  Presence presence;
  presence.Heard({3, 1}, kStart);
  presence.Heard({3, 2}, kStart + 100ms);
  presence.Heard({3, 1}, kStart + 200ms);  // overtaken on the way
  EXPECT_TRUE(presence.IsHere({3, 1}, kStart + 300ms)) << "its spool has it";
  EXPECT_TRUE(presence.IsHere({3, 2}, kStart + 300ms));
  presence.Heard({3, 2}, kStart + 1h);
  EXPECT_TRUE(presence.IsHere({3, 1}, kStart + 1h));
  EXPECT_FALSE(presence.IsHere({3, 3}, kStart + 1h)) << "never heard, and nothing later either";
  EXPECT_THAT(presence.twins(), IsEmpty());
}

TEST(Presence, TwoVehiclesWithOneIdAreFoundByTheirBootCounts) {
  Presence presence;
  for (int i = 0; i < 50; ++i) {
    presence.Heard({3, 1}, kStart + i * 100ms);
    presence.Heard({3, 7}, kStart + i * 100ms);
    presence.Heard({4, 1}, kStart + i * 100ms);
  }
  EXPECT_THAT(presence.twins(), ElementsAre(3));
  EXPECT_TRUE(presence.IsHere({3, 1}, kStart + 5s)) << "both are there, and each is a drive of its own";
}

}  // namespace
}  // namespace mapweld::serve
