// SPDX-License-Identifier: Apache-2.0
// Our transport and a real liblcm talk to each other: every message arrives, in order, unchanged.
#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <poll.h>

#include <atomic>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "drivers/bus/udpm_bus.hpp"
#include "tests/unit/drivers/bus/datagrams.hpp"
#include "tests/unit/drivers/bus/private_network.hpp"

namespace mapweld::bus {
namespace {

using test::Bytes;

constexpr int kMessages = 1000;
constexpr std::size_t kPayloadBytes = 1300;

// The n-th payload; its size differs too.
Bytes Payload(int n) {
  return test::Pattern(static_cast<std::size_t>(n) % kPayloadBytes, static_cast<unsigned>(n));
}

struct Inbox {
  int expected = 0;
  int wrong = 0;
  void Take(std::string_view channel, std::span<const std::uint8_t> payload) {
    const Bytes want = Payload(expected++);
    const bool same =
        channel == "MW.3.KEYFRAME" && std::equal(want.begin(), want.end(), payload.begin(), payload.end());
    wrong += same ? 0 : 1;
  }
};

class LiblcmInterop : public testing::Test {
 protected:
  void SetUp() override {
    if (bus_->Open(test::PrivateUrl(), "MW.3.") != Status::kOk) {
      GTEST_SKIP() << "no multicast on this machine: " << std::strerror(errno);
    }
    lcm_ = lcm_create(test::PrivateUrl().c_str());
    ASSERT_NE(lcm_, nullptr);
  }
  void TearDown() override {
    if (lcm_ != nullptr) lcm_destroy(lcm_);
  }
  static void FromBus(void* context, std::string_view channel, std::span<const std::uint8_t> payload) {
    static_cast<Inbox*>(context)->Take(channel, payload);
  }
  static void FromLcm(const lcm_recv_buf_t* buffer, const char* channel, void* context) {
    static_cast<Inbox*>(context)->Take(channel, {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
  }

  std::unique_ptr<UdpmBus> bus_ = std::make_unique<UdpmBus>();
  lcm_t* lcm_ = nullptr;
  Inbox inbox_;
};

TEST_F(LiblcmInterop, SubscriberHearsEveryMessageOfOurs) {
  lcm_subscription_t* subscription = lcm_subscribe(lcm_, "MW\\.3\\.KEYFRAME", FromLcm, &inbox_);
  lcm_subscription_set_queue_capacity(subscription, 2 * kMessages);
  for (int i = 0; i < kMessages; ++i) {
    ASSERT_EQ(bus_->Publish("MW.3.KEYFRAME", Payload(i)), Status::kOk);
    // Keeps pace with liblcm's reading thread, whose socket buffer is the system's default.
    if (i % 50 == 49) {
      while (inbox_.expected < i && lcm_handle_timeout(lcm_, 1000) > 0) {
      }
    }
  }
  while (inbox_.expected < kMessages && lcm_handle_timeout(lcm_, 1000) > 0) {
  }
  EXPECT_EQ(inbox_.expected, kMessages);
  EXPECT_EQ(inbox_.wrong, 0);
}

TEST_F(LiblcmInterop, OurBusHearsEveryMessageOfAPublisher) {
  for (int i = 0; i < kMessages; ++i) {
    const Bytes payload = Payload(i);
    ASSERT_EQ(lcm_publish(lcm_, "MW.3.KEYFRAME", payload.data(), static_cast<unsigned>(payload.size())), 0);
    ASSERT_TRUE(bus_->Receive({.fn = FromBus, .context = &inbox_}).ok());
  }
  pollfd waiting{.fd = bus_->fd(), .events = POLLIN, .revents = 0};
  while (inbox_.expected<kMessages&& ::poll(&waiting, 1, 1000)> 0) {
    ASSERT_TRUE(bus_->Receive({.fn = FromBus, .context = &inbox_}).ok());
  }
  EXPECT_EQ(inbox_.expected, kMessages);
  EXPECT_EQ(inbox_.wrong, 0);
  EXPECT_EQ(bus_->Rejected(), 0U);
  EXPECT_EQ(bus_->counters().kernel_drops, 0U);
}

TEST_F(LiblcmInterop, RefusesALibraryMessageLargerThanASlotWithoutLosingTheNext) {
  const Bytes large(200'000);
  ASSERT_EQ(lcm_publish(lcm_, "MW.3.KEYFRAME", large.data(), static_cast<unsigned>(large.size())), 0);
  const Bytes small = Payload(0);
  ASSERT_EQ(lcm_publish(lcm_, "MW.3.KEYFRAME", small.data(), static_cast<unsigned>(small.size())), 0);
  pollfd waiting{.fd = bus_->fd(), .events = POLLIN, .revents = 0};
  while (inbox_.expected < 1 && ::poll(&waiting, 1, 1000) > 0) {
    ASSERT_TRUE(bus_->Receive({.fn = FromBus, .context = &inbox_}).ok());
  }
  EXPECT_EQ(inbox_.expected, 1);
  EXPECT_GT(bus_->counters().too_large, 0U);
}

}  // namespace
}  // namespace mapweld::bus
