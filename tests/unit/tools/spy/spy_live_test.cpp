// SPDX-License-Identifier: Apache-2.0
// The tap on a real network: what liblcm and our own transport send, with messages left out by number.
#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <thread>

#include "drivers/bus/udpm_bus.hpp"
#include "drivers/messages/codec.hpp"
#include "drivers/time/monotonic_clock.hpp"
#include "tests/support/sample_messages.hpp"
#include "tests/unit/drivers/bus/private_network.hpp"
#include "tools/spy/lcm_tap.hpp"

namespace mapweld::spy {
namespace {

using namespace std::chrono_literals;

TEST(LcmTap, HearsLiblcmAndUsAndSaysWhoSaidWhat) {
  const std::string url = bus::test::PrivateUrl();
  const auto ours = std::make_unique<bus::UdpmBus>();
  if (ours->Open(url) != Status::kOk) GTEST_SKIP() << "no multicast on this machine: " << std::strerror(errno);
  lcm::LCM liblcm(url);
  ASSERT_TRUE(liblcm.good());
  LcmTap tap(url);
  Traffic traffic(time::MonotonicNow(), FromSeconds(60));
  const auto message = test::SampleMessage<mapweldlcm::health_t>();
  std::vector<std::uint8_t> encoded(1024);
  encoded.resize(messages::Encode(message, encoded).value());
  const std::vector<std::uint8_t> large(150'000, 7);
  for (int i = 0; i < 50; ++i) {
    liblcm.publish("MW.9.HEALTH", &message);
    if (i % 10 == 0) liblcm.publish("LARGE", large.data(), static_cast<unsigned>(large.size()));  // three fragments
    ASSERT_EQ(ours->Publish("MW.3.HEALTH", encoded), Status::kOk);
    tap.Listen(20ms, &traffic);
  }
  const TrafficReport report = traffic.Report(time::MonotonicNow());
  EXPECT_EQ(tap.missed(), 0U);
  EXPECT_EQ(report.not_lcm, 0U);
  ASSERT_EQ(report.senders.size(), 2U);
  for (const SenderReport& sender : report.senders) {
    EXPECT_EQ(sender.lost, 0U);
    for (const ChannelReport& channel : sender.channels) {
      EXPECT_EQ(channel.messages, channel.channel == "LARGE" ? 5U : 50U);
      if (channel.channel == "LARGE") continue;
      EXPECT_EQ(channel.type, "health_t");
      EXPECT_EQ(channel.refused, 0U);
      EXPECT_GT(channel.hz, 5.0);
      EXPECT_LT(channel.hz, 51.0);
    }
  }
}

TEST(LcmTap, RefusesWhatIsNoLcmNetwork) {
  EXPECT_THROW(LcmTap("tcp://127.0.0.1:7667"), std::runtime_error);
  EXPECT_THROW(LcmTap("udpm://10.0.0.1:7667"), std::runtime_error) << "not a multicast address";
}

}  // namespace
}  // namespace mapweld::spy
