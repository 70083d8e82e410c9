// SPDX-License-Identifier: Apache-2.0
#include "drivers/bus/lcm_url.hpp"

#include <gtest/gtest.h>

namespace mapweld::bus {
namespace {

TEST(LcmUrl, ReadsEveryPart) {
  UdpmAddress address;
  ASSERT_EQ(ParseLcmUrl("udpm://239.1.2.3:7700?ttl=2&recv_buf_size=1000000", &address), Status::kOk);
  EXPECT_EQ(address.group_ipv4, 0xEF010203U);
  EXPECT_EQ(address.port, 7700);
  EXPECT_EQ(address.ttl, 2);
  EXPECT_EQ(address.receive_buffer_bytes, 1'000'000U);
}

TEST(LcmUrl, FillsInWhatIsLeftOut) {
  for (const char* url :
       {"udpm://", "udpm://239.255.76.67", "udpm://:7667", "udpm://?ttl=0", "udpm://239.255.76.67:7667?"}) {
    UdpmAddress address{.group_ipv4 = 1, .port = 1, .ttl = 9, .receive_buffer_bytes = 1};
    ASSERT_EQ(ParseLcmUrl(url, &address), Status::kOk) << url;
    EXPECT_EQ(address.group_ipv4, 0xEFFF4C43U);
    EXPECT_EQ(address.port, 7667);
    EXPECT_EQ(address.ttl, 0);
  }
}

TEST(LcmUrl, RefusesWhatItCannotMean) {
  for (const char* url : {"",
                          "udpm",
                          "udpm:/",
                          "udp://239.1.1.1",
                          "tcpq://",
                          "memq://",
                          "mpudpm://239.255.76.67:7667",
                          "udpm://192.168.1.1",
                          "udpm://223.255.255.255",
                          "udpm://240.0.0.1",
                          "udpm://239.1.1",
                          "udpm://239.1.1.1.1",
                          "udpm://239.1.1.256",
                          "udpm://239..1.1",
                          "udpm://239.1.1.1:",
                          "udpm://239.1.1.1:0",
                          "udpm://239.1.1.1:65536",
                          "udpm://239.1.1.1:99999999999999",
                          "udpm://239.1.1.1:7667x",
                          "udpm://239.1.1.1?ttl=256",
                          "udpm://?ttl=",
                          "udpm://?ttl=-1",
                          "udpm://?ttl=1&ttl=2",
                          "udpm://?ttl=1&",
                          "udpm://?speed=9",
                          "udpm://?recv_buf_size=0",
                          "udpm://?recv_buf_size=4294967296",
                          "udpm:// 239.1.1.1",
                          "udpm://239.1.1.1 "}) {
    UdpmAddress address{.port = 42};
    EXPECT_EQ(ParseLcmUrl(url, &address), Status::kBadInput) << url;
    EXPECT_EQ(address.port, 42) << "untouched";
  }
}

}  // namespace
}  // namespace mapweld::bus
