// SPDX-License-Identifier: Apache-2.0
// The agent's mouth and the host's ear with a network between them that loses, repeats and reorders: by the end every
// keyframe is there, and every submap that was wanted. Sensors and odometry are left out.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "core/submap/submap_codec.hpp"
#include "drivers/bus/udpm_bus.hpp"
#include "drivers/time/monotonic_clock.hpp"
#include "firmware-like/answer_queue.hpp"
#include "firmware-like/telemetry.hpp"
#include "tests/support/sort_points.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tools/serve/requester.hpp"

namespace mapweld {
namespace {

constexpr std::uint32_t kGroup = 0xEFFF4C43;  // 239.255.76.67

// One side of the relay: hears everything on a port of the group except what it sent itself.
class Side {
 public:
  explicit Side(std::uint16_t port) {
    in_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0);
    out_ = ::socket(AF_INET, SOCK_DGRAM, 0);
    const int on = 1;
    const int bytes = 4 << 20;
    const int ttl = 0;
    address_.sin_family = AF_INET;
    address_.sin_port = htons(port);
    ip_mreq membership{};
    membership.imr_multiaddr.s_addr = htonl(kGroup);
    (void)::setsockopt(in_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    (void)::setsockopt(in_, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof(bytes));
    good_ = ::bind(in_, reinterpret_cast<sockaddr*>(&address_), sizeof(address_)) == 0 &&
            ::setsockopt(in_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) == 0 &&
            ::setsockopt(out_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof(ttl)) == 0;
    address_.sin_addr.s_addr = htonl(kGroup);
    sockaddr_in any{};
    any.sin_family = AF_INET;
    socklen_t length = sizeof(any);
    good_ = good_ && ::bind(out_, reinterpret_cast<sockaddr*>(&any), sizeof(any)) == 0 &&
            ::getsockname(out_, reinterpret_cast<sockaddr*>(&any), &length) == 0;
    own_port_ = any.sin_port;
  }
  ~Side() {
    ::close(in_);
    ::close(out_);
  }
  Side(const Side&) = delete;
  Side& operator=(const Side&) = delete;

  // false when nothing is there.
  bool Receive(std::vector<std::uint8_t>* datagram) const {
    for (;;) {
      sockaddr_in from{};
      socklen_t length = sizeof(from);
      datagram->resize(65507);
      const ssize_t got =
          ::recvfrom(in_, datagram->data(), datagram->size(), 0, reinterpret_cast<sockaddr*>(&from), &length);
      if (got < 0) return false;
      datagram->resize(static_cast<std::size_t>(got));
      if (from.sin_port != own_port_) return true;
    }
  }
  void Send(const std::vector<std::uint8_t>& datagram) const {
    (void)::sendto(out_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&address_),
                   sizeof(address_));
  }
  [[nodiscard]] bool good() const { return good_; }

 private:
  int in_ = -1;
  int out_ = -1;
  bool good_ = false;
  sockaddr_in address_{};
  in_port_t own_port_ = 0;
};

// Carries datagrams between two networks, and loses, repeats and delays some.
class Relay {
 public:
  Relay(std::uint16_t a, std::uint16_t b, double loss, std::uint32_t seed)
      : loss_(loss), whole_loss_(loss), random_(seed), a_(a), b_(b) {}

  void Step() {
    Carry(a_, b_);
    Carry(b_, a_);
  }
  // The two networks no longer reach each other, or again.
  void Cut(bool cut) { loss_ = cut ? 1 : whole_loss_; }
  [[nodiscard]] bool good() const { return a_.good() && b_.good(); }
  [[nodiscard]] int carried() const { return carried_; }
  [[nodiscard]] int lost() const { return lost_; }

 private:
  bool Happens(double probability) { return std::uniform_real_distribution<double>(0, 1)(random_) < probability; }
  void Carry(const Side& from, const Side& to) {
    std::vector<std::uint8_t> datagram;
    while (from.Receive(&datagram)) {
      ++carried_;
      if (Happens(loss_)) {
        ++lost_;
        continue;
      }
      if (Happens(0.05)) {  // overtaken by the next one
        delayed_.emplace_back(&to, datagram);
        continue;
      }
      to.Send(datagram);
      if (Happens(0.05)) to.Send(datagram);
      for (const auto& [side, late] : delayed_) side->Send(late);
      delayed_.clear();
    }
  }

  double loss_;
  double whole_loss_;
  std::mt19937 random_;
  Side a_;
  Side b_;
  std::vector<std::pair<const Side*, std::vector<std::uint8_t>>> delayed_;
  int carried_ = 0;
  int lost_ = 0;
};

std::string Url(std::uint16_t port) {
  return "udpm://239.255.76.67:" + std::to_string(port) + "?ttl=0";
}

// Keyframes from nowhere, published and spooled as the agent does it.
class SmallAgent {
 public:
  SmallAgent(const std::string& url, const std::string& state_directory, std::int32_t epoch)
      : telemetry_({.agent_id = 3, .epoch = epoch}, bus_.get()) {
    good_ = bus_->Open(url, "MW.3.") == Status::kOk &&
            spool_->Open((state_directory + "/spool").c_str(), 8 << 20) == Status::kOk;
    submap_->points.clear();
    for (int x = 0; x < 40; ++x) {
      for (int y = 0; y < 40; ++y) {
        (void)submap_->points.TryPush(
            {.x = 0.5F * static_cast<float>(y), .y = 0.5F * static_cast<float>(x), .z = 0.1F, .count = 1});
      }
    }
    test::SortPoints(submap_.get());
    const auto bytes = std::make_unique<submap::SubmapEncoder>()->Encode(*submap_, encoded_);
    encoded_.resize(bytes.ok() ? bytes.value() : 0);
    good_ = good_ && bytes.ok();
  }
  void PublishKeyframe() {
    pipeline::KeyframeOutput keyframe;
    keyframe.index = keyframes_++;
    keyframe.t = {keyframe.index * 500'000'000LL};
    keyframe.submap_points = submap_->points.size();
    keyframe.place.descriptor.scale = 0.01F;
    keyframe.encoded = encoded_;
    const auto message = telemetry_.PublishKeyframe(keyframe);
    const std::int32_t epoch = telemetry_.identity().epoch;
    (void)spool_->Append({epoch, static_cast<std::uint8_t>(executive::RecordKind::kKeyframe), keyframe.index}, message);
    (void)spool_->Append({epoch, static_cast<std::uint8_t>(executive::RecordKind::kSubmap), keyframe.index}, encoded_);
  }
  void PublishHealth(bool ended) {
    mapweldlcm::health_t health{};
    health.mode = ended ? 4 : 2;
    health.keyframes = keyframes_;
    telemetry_.PublishHealth(&health);
  }
  void Step() {
    const auto take = [](void* self, std::string_view channel, std::span<const std::uint8_t> payload) {
      const auto parsed = messages::ParseChannel(channel);
      mapweldlcm::request_t request;
      if (parsed.ok() && parsed.value().kind == messages::Kind::kRequest &&
          messages::Decode(payload, &request) == Status::kOk) {
        static_cast<SmallAgent*>(self)->answers_->Add(request);
      }
    };
    (void)bus_->Receive({take, this});
    (void)answers_->Step(time::MonotonicNow());
  }
  void Remind() { answers_->RemindOfEarlierDrives(); }
  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] std::size_t submap_bytes() const { return encoded_.size(); }

 private:
  bool good_ = false;
  std::unique_ptr<bus::UdpmBus> bus_ = std::make_unique<bus::UdpmBus>();
  std::unique_ptr<spool::RecordSpool> spool_ = std::make_unique<spool::RecordSpool>();
  executive::Telemetry telemetry_;
  std::unique_ptr<executive::AnswerQueue> answers_ =
      std::make_unique<executive::AnswerQueue>(1'000'000, spool_.get(), &telemetry_);
  std::unique_ptr<submap::Submap> submap_ = std::make_unique<submap::Submap>();
  std::vector<std::uint8_t> encoded_ = std::vector<std::uint8_t>(1 << 16);
  std::int32_t keyframes_ = 0;
};

class LossyNetwork : public testing::TestWithParam<int> {};

TEST_P(LossyNetwork, BringsEveryKeyframeAndEveryWantedSubmap) {
  using Clock = std::chrono::steady_clock;
  using namespace std::chrono_literals;
  constexpr std::int32_t kKeyframes = 300;
  const std::vector<std::int32_t> wanted{0, 17, 100, 200, 299};
  const auto port = static_cast<std::uint16_t>(20'000 + ::getpid() % 20'000);
  const auto other_port = static_cast<std::uint16_t>(port + 20'001);
  const test::TemporaryDirectory state;
  SmallAgent agent(Url(port), state.path().string(), 1);
  Relay relay(port, other_port, GetParam() / 100.0, 42);
  if (!agent.good() || !relay.good()) GTEST_SKIP() << "no multicast on this machine: " << std::strerror(errno);
  serve::FleetLink host(Url(other_port));
  serve::Requester requester(&host);
  const serve::DriveId id{3, 1};
  std::vector<serve::Requester::Submap> submaps;
  for (const std::int32_t keyframe : wanted) submaps.push_back({id, keyframe});
  requester.Want(submaps);

  const auto complete = [&] {
    return host.WithStore([&](const serve::FleetStore& store) { return store.IsComplete(id); }) &&
           requester.outstanding() == 0;
  };
  std::int32_t published = 0;
  auto next_keyframe = Clock::now();
  auto next_health = Clock::now();
  const auto deadline = Clock::now() + 60s;
  while (Clock::now() < deadline && !(published == kKeyframes && complete())) {
    if (published < kKeyframes && Clock::now() >= next_keyframe) {
      agent.PublishKeyframe();
      ++published;
      next_keyframe += 10ms;
    }
    if (Clock::now() >= next_health) {
      agent.PublishHealth(published == kKeyframes);
      next_health += 50ms;
    }
    agent.Step();
    relay.Step();
    requester.Step(Clock::now());
    std::this_thread::sleep_for(1ms);
  }
  host.WithStore([&](const serve::FleetStore& store) {
    const auto drives = store.Drives();
    ASSERT_EQ(drives.drives.size(), 1U);
    EXPECT_EQ(drives.drives[0].keyframes.size(), static_cast<std::size_t>(kKeyframes));
    for (const std::int32_t keyframe : wanted) EXPECT_NE(store.FindSubmap(id, keyframe), nullptr) << keyframe;
    EXPECT_EQ(store.counters().broken_submaps, 0U);
    std::printf(
        "%d %% loss: %d datagrams carried, %d lost, %zu keyframes, %zu of %zu bytes each submap, %llu keyframes "
        "repeated\n",
        GetParam(), relay.carried(), relay.lost(), drives.drives[0].keyframes.size(), wanted.size(),
        agent.submap_bytes(), static_cast<unsigned long long>(store.counters().repeated_keyframes));
  });
  EXPECT_EQ(host.refused(), 0U);
}

// The agent drives on while nobody hears it, and the host is killed and started again in that time. When the network
// heals, everything comes that was not there, and nothing comes twice that was on the disk.
TEST(PartitionedNetwork, HealsWithEverythingFromTheTimeApart) {
  using Clock = std::chrono::steady_clock;
  using namespace std::chrono_literals;
  constexpr std::int32_t kKeyframes = 200;
  const auto port = static_cast<std::uint16_t>(20'000 + ::getpid() % 20'000);
  const auto other_port = static_cast<std::uint16_t>(port + 20'001);
  const test::TemporaryDirectory directory;
  SmallAgent agent(Url(port));
  Relay relay(port, other_port, 0.1, 7);
  if (!agent.good() || !relay.good()) GTEST_SKIP() << "no multicast on this machine: " << std::strerror(errno);
  const serve::DriveId id{3, 1};
  auto city = std::make_unique<store::CityStore>(directory.File("city.db"));
  auto host = std::make_unique<serve::FleetLink>(Url(other_port), city.get());
  auto requester = std::make_unique<serve::Requester>(host.get());
  std::int32_t published = 0;
  std::size_t kept = 0;  // on the disk when the host was killed
  auto next = Clock::now();
  const auto deadline = Clock::now() + 60s;
  const auto complete = [&] {
    return published == kKeyframes &&
           host->WithStore([&](const serve::FleetStore& store) { return store.IsComplete(id); });
  };
  while (Clock::now() < deadline && !complete()) {
    if (Clock::now() >= next) {
      next += 10ms;
      if (published < kKeyframes) {
        agent.PublishKeyframe();
        ++published;
        if (published == 50) relay.Cut(true);
        if (published == 150) {
          requester.reset();
          host.reset();
          city = nullptr;
          city = std::make_unique<store::CityStore>(directory.File("city.db"));
          kept = city->Keyframes(1).size();
          host = std::make_unique<serve::FleetLink>(Url(other_port), city.get());
          requester = std::make_unique<serve::Requester>(host.get());
          relay.Cut(false);
        }
      }
      agent.PublishHealth(published == kKeyframes);
    }
    agent.Step();
    relay.Step();
    requester->Step(Clock::now());
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_TRUE(complete());
  EXPECT_GE(kept, 10U);
  EXPECT_LE(kept, 50U);
  host->WithStore([&](const serve::FleetStore& store) {
    ASSERT_EQ(store.Drives().drives.size(), 1U);
    EXPECT_EQ(store.Drives().drives[0].keyframes.size(), static_cast<std::size_t>(kKeyframes));
  });
  host.reset();
  EXPECT_EQ(city->Keyframes(1).size(), static_cast<std::size_t>(kKeyframes));
}

// The power fails in the middle of the drive, while the network is away: the host has heard neither the last keyframes
// of the first drive nor how many there were. By the end it has both drives whole.
TEST_P(LossyNetwork, BringsTheKeyframesOfTheDriveBeforeAReboot) {
  using Clock = std::chrono::steady_clock;
  using namespace std::chrono_literals;
  constexpr std::int32_t kKeyframes = 100;
  const std::vector<std::int32_t> wanted{0, 50, 99};
  const auto port = static_cast<std::uint16_t>(20'000 + ::getpid() % 20'000);
  const auto other_port = static_cast<std::uint16_t>(port + 20'001);
  const test::TemporaryDirectory state;
  auto agent = std::make_unique<SmallAgent>(Url(port), state.path().string(), 1);
  auto relay = std::make_unique<Relay>(port, other_port, GetParam() / 100.0, 43);
  if (!agent->good() || !relay->good()) GTEST_SKIP() << "no multicast on this machine: " << std::strerror(errno);
  serve::FleetLink host(Url(other_port));
  serve::Requester requester(&host);
  const serve::DriveId before{3, 1};
  const serve::DriveId after{3, 2};
  requester.Want(before, wanted);

  const auto keyframes = [&](const serve::DriveId& id) {
    return host.WithStore([&](const serve::FleetStore& store) {
      const auto fleet = store.Drives();
      for (std::size_t d = 0; d < fleet.ids.size(); ++d) {
        if (fleet.ids[d] == id) return fleet.drives[d].keyframes.size();
      }
      return std::size_t{0};
    });
  };
  const auto run = [&](Clock::duration time, std::int32_t publish, const auto& done) {
    const auto deadline = Clock::now() + time;
    auto next_remind = Clock::now();
    for (int step = 0; Clock::now() < deadline && !(publish <= 0 && done()); ++step) {
      if (step % 3 == 0 && publish-- > 0) agent->PublishKeyframe();
      if (step % 50 == 0) agent->PublishHealth(false);
      if (Clock::now() >= next_remind) {  // the agent does so every kRemindEvery
        agent->Remind();
        next_remind += 500ms;
      }
      agent->Step();
      relay->Step();
      requester.Step(Clock::now());
      std::this_thread::sleep_for(1ms);
    }
  };
  run(10s, kKeyframes / 2, [] { return true; });
  relay = std::make_unique<Relay>(port, other_port, 1.0, 44);
  run(10s, kKeyframes / 2, [] { return true; });
  const std::size_t heard = keyframes(before);
  ASSERT_LE(heard, static_cast<std::size_t>(kKeyframes / 2));

  agent.reset();
  agent = std::make_unique<SmallAgent>(Url(port), state.path().string(), 2);
  ASSERT_TRUE(agent->good());
  relay = std::make_unique<Relay>(port, other_port, GetParam() / 100.0, 45);
  run(60s, kKeyframes, [&] {
    return keyframes(before) == kKeyframes && keyframes(after) == kKeyframes && requester.outstanding() == 0;
  });
  EXPECT_EQ(keyframes(before), static_cast<std::size_t>(kKeyframes));
  EXPECT_EQ(keyframes(after), static_cast<std::size_t>(kKeyframes));
  EXPECT_EQ(requester.outstanding(), 0U) << "submaps of the drive before the reboot";
  EXPECT_EQ(host.refused(), 0U);
  std::printf("%d %% loss: %zu of %d keyframes heard before the reboot, all after it\n", GetParam(), heard, kKeyframes);
}

INSTANTIATE_TEST_SUITE_P(PerCent, LossyNetwork, testing::Values(0, 10, 30));

}  // namespace
}  // namespace mapweld
