// SPDX-License-Identifier: Apache-2.0
#include "tools/spy/traffic.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "drivers/messages/codec.hpp"
#include "tests/support/sample_messages.hpp"
#include "tests/unit/drivers/bus/datagrams.hpp"
#include "tools/spy/traffic_view.hpp"

namespace mapweld::spy {
namespace {

constexpr Sender kAgent{.ipv4 = 0x0A000003, .port = 5000};

template <class Message>
std::vector<std::uint8_t> Payload() {
  std::vector<std::uint8_t> bytes(4096);
  const auto n = messages::Encode(test::SampleMessage<Message>(), bytes);
  bytes.resize(n.value());
  return bytes;
}

TEST(Traffic, MeasuresRateBytesAndJitterOfAChannel) {
  Traffic traffic({0}, FromSeconds(100));
  const auto payload = Payload<mapweldlcm::pose_t>();
  for (std::uint32_t i = 0; i < 100; ++i) {  // every 100 ms, 2 ms early and late by turns
    const std::int64_t t_ms = 100LL * i + (i % 2 == 0 ? 4 : 0);
    traffic.Take({t_ms * 1'000'000}, kAgent, bus::test::Short(i, "MW.3.POSE", payload));
  }
  const TrafficReport report = traffic.Report({10'000'000'000});
  ASSERT_EQ(report.senders.size(), 1U);
  ASSERT_EQ(report.senders[0].channels.size(), 1U);
  const ChannelReport& channel = report.senders[0].channels[0];
  EXPECT_EQ(channel.type, "pose_t");
  EXPECT_EQ(channel.messages, 100U);
  EXPECT_EQ(channel.refused, 0U);
  EXPECT_DOUBLE_EQ(channel.hz, 10.0);
  EXPECT_NEAR(channel.bytes_per_s, 10.0 * static_cast<double>(payload.size()), 1e-6);
  EXPECT_NEAR(channel.jitter_ms, 4.0, 0.1);
  EXPECT_NEAR(channel.longest_ms, 104.0, 1e-6);
  EXPECT_EQ(report.senders[0].lost, 0U);
}

TEST(Traffic, ForgetsWhatIsOlderThanItsWindow) {
  Traffic traffic({0}, FromSeconds(10));
  for (std::uint32_t i = 0; i < 200; ++i) {
    traffic.Take({i * 100'000'000LL}, kAgent, bus::test::Short(i, "X", bus::test::Pattern(8)));
  }
  EXPECT_NEAR(traffic.Report({20'000'000'000}).senders[0].channels[0].hz, 10.0, 0.11);
  EXPECT_EQ(traffic.Report({40'000'000'000}).senders[0].channels[0].hz, 0.0);
  EXPECT_EQ(traffic.Report({40'000'000'000}).senders[0].channels[0].messages, 200U);
}

TEST(Traffic, TellsTwoProgramsOnOneChannelApartAndCountsTheLossesOfEach) {
  constexpr Sender kOther{.ipv4 = 0x0A000004, .port = 5000};
  Traffic traffic({0}, FromSeconds(10));
  for (std::uint32_t i = 0; i < 10; ++i) {
    if (i != 4) traffic.Take({i}, kAgent, bus::test::Short(i, "MW.3.POSE", bus::test::Pattern(8)));
    if (i % 3 == 0) traffic.Take({i}, kOther, bus::test::Short(70 + i, "MW.3.POSE", bus::test::Pattern(8)));
  }
  const TrafficReport report = traffic.Report({10});
  ASSERT_EQ(report.senders.size(), 2U);
  EXPECT_EQ(report.senders[0].lost, 1U);
  EXPECT_EQ(report.senders[1].lost, 6U);
  EXPECT_EQ(report.senders[0].messages, 9U);
}

TEST(Traffic, PutsFragmentsTogetherAndCallsAMessageWithoutOneLost) {
  Traffic traffic({0}, FromSeconds(10));
  const auto piece = [&](std::uint32_t sequence, int number) {
    const auto offset = static_cast<std::uint32_t>(30 * number);
    traffic.Take(
        {1}, kAgent,
        bus::test::Fragment(
            {.sequence = sequence, .size = 90, .offset = offset, .number = static_cast<unsigned>(number), .count = 3},
            bus::test::Pattern(30)));
  };
  for (const int number : {2, 0, 1, 1}) piece(5, number);  // any order, and one comes again
  for (std::uint32_t sequence = 6; sequence < 6 + 65; ++sequence) {
    piece(sequence, 0);
    piece(sequence, 2);
  }
  const TrafficReport report = traffic.Report({10});
  EXPECT_EQ(report.senders[0].messages, 1U);
  EXPECT_EQ(report.senders[0].lost, 1U) << "64 may still be completed";
  EXPECT_EQ(report.senders[0].repeated, 1U);
}

TEST(Traffic, NamesWhatTheAgentsWouldRefuse) {
  Traffic traffic({0}, FromSeconds(10));
  auto payload = Payload<mapweldlcm::health_t>();
  traffic.Take({1}, kAgent, bus::test::Short(0, "MW.3.HEALTH", payload));
  traffic.Take({2}, kAgent, bus::test::Short(1, "MW.3.POSE", payload));  // not what belongs there
  ++payload[7];                                                          // another version of the type
  traffic.Take({3}, kAgent, bus::test::Short(2, "MW.4.HEALTH", payload));
  traffic.Take({4}, kAgent, bus::test::Short(3, "OTHER", payload));  // not ours to judge
  const auto channels = traffic.Report({10}).senders.at(0).channels;
  ASSERT_EQ(channels.size(), 4U);
  EXPECT_EQ(channels[0].refused, 0U);
  EXPECT_EQ(channels[1].refused, 1U);
  EXPECT_EQ(channels[1].type, "health_t");
  EXPECT_EQ(channels[2].refused, 1U);
  EXPECT_EQ(channels[2].type.substr(0, 2), "0x");
  EXPECT_EQ(channels[3].refused, 0U);
}

TEST(Traffic, OutlivesEveryHostileDatagram) {
  Traffic traffic({0}, FromSeconds(10));
  for (const auto& datagram : bus::test::HostileDatagrams()) traffic.Take({1}, kAgent, datagram);
  for (std::uint32_t i = 0; i < 3000; ++i) {
    traffic.Take({2}, {.ipv4 = i, .port = 1}, bus::test::Short(1, "X", bus::test::Pattern(8)));
    traffic.Take({2}, kAgent, bus::test::Short(i, "C" + std::to_string(i), bus::test::Pattern(8)));
  }
  const TrafficReport report = traffic.Report({10});
  EXPECT_GT(report.not_lcm, 0U);
  EXPECT_LE(report.senders.size(), 1001U);
  for (const SenderReport& sender : report.senders) EXPECT_LE(sender.channels.size(), 1001U);
}

TEST(TrafficView, LetsNoControlCharacterThrough) {
  Traffic traffic({0}, FromSeconds(10));
  traffic.Take({1}, kAgent, bus::test::Short(0, "\x1b[2J\"\xff", bus::test::Pattern(8)));
  const TrafficReport report = traffic.Report({10});
  EXPECT_EQ(TrafficTable(report, "udpm://", 0).find('\x1b'), std::string::npos);
  const auto json = nlohmann::json::parse(TrafficJson(report, "udpm://", 3));
  EXPECT_EQ(json["senders"][0]["channels"][0]["channel"], "?[2J\"?");
  EXPECT_EQ(json["senders"][0]["address"], "10.0.0.3:5000");
  EXPECT_EQ(json["missed_here"], 3);
}

}  // namespace
}  // namespace mapweld::spy
