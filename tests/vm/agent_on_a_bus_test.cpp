// SPDX-License-Identifier: Apache-2.0
// The agent, as it ships, on a CAN bus of the kernel: an IMU at 400 Hz while the bus misbehaves. Needs vcan0 and the
// right to switch it off and on; toolchain/vm/bench brings both. The path of the agent is the first argument.
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "drivers/bus/udpm_bus.hpp"
#include "drivers/can/xsens_codec.hpp"
#include "drivers/messages/channel.hpp"
#include "drivers/messages/codec.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/drivers/bus/private_network.hpp"
#include "tests/unit/drivers/can/xsens_frames.hpp"

namespace mapweld {
namespace {

using namespace std::chrono_literals;

std::string agent_program;

class Bus {
 public:
  bool Open() {
    fd_ = ::socket(PF_CAN, SOCK_RAW, CAN_RAW);
    // Its own frames would only fill its own buffer.
    return fd_ >= 0 && ::setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0) == 0 && Connect();
  }
  // To the vcan0 of today.
  bool Connect() const {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex("vcan0"));
    return ::bind(fd_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
  }
  ~Bus() {
    if (fd_ >= 0) ::close(fd_);
  }
  // Tells whether the frame is on the bus.
  bool Send(canid_t id, std::span<const std::uint8_t> data) const {
    can_frame frame{};
    frame.can_id = id;
    frame.can_dlc = static_cast<std::uint8_t>(data.size());
    std::memcpy(frame.data, data.data(), data.size());
    return ::write(fd_, &frame, sizeof(frame)) == static_cast<ssize_t>(sizeof(frame));
  }
  void Switch(bool on) const {
    ifreq request{};
    std::strncpy(request.ifr_name, "vcan0", IFNAMSIZ - 1);
    ASSERT_EQ(::ioctl(fd_, SIOCGIFFLAGS, &request), 0);
    request.ifr_flags = static_cast<short>(on ? request.ifr_flags | IFF_UP : request.ifr_flags & ~IFF_UP);
    ASSERT_EQ(::ioctl(fd_, SIOCSIFFLAGS, &request), 0);
  }

 private:
  int fd_ = -1;
};

// The sensor: one sample of five frames every 2.5 ms of its own clock.
class Imu {
 public:
  explicit Imu(const Bus* bus) : bus_(bus) {}
  void Sample() {
    for (const can::CanFrame& frame :
         can::test::Group({.ticks = 25 * samples_, .counter = static_cast<std::uint16_t>(samples_)})) {
      frames_ += bus_->Send(frame.id, std::span(frame.data).first(frame.dlc)) ? 1 : 0;
    }
    ++samples_;
  }
  // `disturb` runs before every sample.
  void RunFor(
      std::chrono::milliseconds time, const std::function<void()>& disturb = [] {}) {
    auto next = std::chrono::steady_clock::now();
    for (auto t = 0us; t < time; t += 2500us) {
      disturb();
      Sample();
      std::this_thread::sleep_until(next += 2500us);
    }
  }
  [[nodiscard]] std::int64_t frames() const { return frames_; }  // that got onto the bus
  [[nodiscard]] std::int64_t samples() const { return samples_; }

 private:
  const Bus* bus_;
  std::uint32_t samples_ = 0;
  std::int64_t frames_ = 0;
};

class AgentOnABus : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(bus_.Open()) << "vcan0: " << std::strerror(errno);
    url_ = bus::test::PrivateUrl();
    ASSERT_EQ(lcm_->Open(url_, "MW.7."), Status::kOk) << std::strerror(errno);
    agent_ = ::fork();
    if (agent_ == 0) {
      ::execl(agent_program.c_str(), "mapweld-agent", "--agent-id", "7", "--state-dir", state_.path().c_str(), "--can",
              "vcan0", "--lcm-url", url_.c_str(), "--spool-mib", "1", nullptr);
      ::_exit(127);
    }
    ASSERT_NO_FATAL_FAILURE(NextHealth());
  }
  void TearDown() override {
    if (agent_ > 0) ::kill(agent_, SIGKILL);
  }
  // The agent's own report, made after this call.
  void NextHealth() {
    while (ReadHealth(0)) {
    }
    ASSERT_TRUE(ReadHealth(10'000)) << "the agent says nothing";
    ASSERT_TRUE(ReadHealth(10'000));
  }
  // Until the agent has taken every frame of the bus that the kernel did not drop.
  void WaitForAllFrames() {
    for (int i = 0; i < 100; ++i) {
      ASSERT_NO_FATAL_FAILURE(NextHealth());
      if (health_.can_frames + health_.kernel_drops >= imu_.frames() + error_frames_) return;
    }
  }
  void SendErrors(int n) {
    const std::array<std::uint8_t, 8> data{};
    for (int i = 0; i < n; ++i) error_frames_ += bus_.Send(CAN_ERR_FLAG | CAN_ERR_PROT, data) ? 1 : 0;
  }
  // The first groups only tell the agent the unit of SampleTime. The very last one may wait for its successor, when
  // this machine was so busy that it came late; nothing may be refused.
  [[nodiscard]] std::int64_t Lost() const {
    return imu_.samples() - can::XsensCodec::kDetectGroups - health_.imu_samples;
  }
  // Nothing is lost but what the kernel dropped while the agent was not given a processor, and all of that is counted.
  void ExpectNothingLostUncounted() const {
    EXPECT_EQ(health_.can_frames + health_.kernel_drops, imu_.frames() + error_frames_);
    EXPECT_LE(Lost(), 1 + health_.kernel_drops);
    if (health_.kernel_drops == 0) {
      EXPECT_EQ(health_.imu_rejected, error_frames_);
    }
  }

  mapweldlcm::health_t health_{};
  Bus bus_;
  Imu imu_{&bus_};
  std::int64_t error_frames_ = 0;
  pid_t agent_ = -1;
  std::unique_ptr<bus::UdpmBus> lcm_ = std::make_unique<bus::UdpmBus>();

 private:
  bool ReadHealth(int wait_ms) {
    heard_ = false;
    const auto take = [](void* self, std::string_view channel, std::span<const std::uint8_t> payload) {
      auto* test = static_cast<AgentOnABus*>(self);
      const auto parsed = messages::ParseChannel(channel);
      if (!parsed.ok() || parsed.value().kind != messages::Kind::kHealth) return;
      test->heard_ = messages::Decode(payload, &test->health_) == Status::kOk;
    };
    pollfd waiting{.fd = lcm_->fd(), .events = POLLIN, .revents = 0};
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(wait_ms);
    while (!heard_) {  // what the test itself published comes back, too
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
      if (::poll(&waiting, 1, std::max(0, static_cast<int>(left.count()))) <= 0) return false;
      if (!lcm_->Receive({take, this}, 1).ok()) return false;
    }
    return true;
  }

  bool heard_ = false;
  std::string url_;
  test::TemporaryDirectory state_;
};

TEST_F(AgentOnABus, TurnsEveryGroupOfA400HzImuIntoASample) {
  imu_.RunFor(3s);
  ASSERT_NO_FATAL_FAILURE(WaitForAllFrames());
  ExpectNothingLostUncounted();
  EXPECT_EQ(health_.heap_calls, 0);
}

TEST_F(AgentOnABus, LosesNothingInAFloodOfErrorFrames) {
  imu_.RunFor(2s, [&] { SendErrors(13); });  // 5200 per second
  ASSERT_NO_FATAL_FAILURE(WaitForAllFrames());
  EXPECT_GT(error_frames_, 5000);
  ExpectNothingLostUncounted();
}

TEST_F(AgentOnABus, DoesNotHearABabblingNode) {
  const std::array<std::uint8_t, 8> data{};
  std::int64_t babble = 0;
  imu_.RunFor(2s, [&] {
    for (int i = 0; i < 20; ++i) babble += bus_.Send(static_cast<canid_t>(0x100 + i), data) ? 1 : 0;
  });
  ASSERT_NO_FATAL_FAILURE(WaitForAllFrames());
  EXPECT_GT(babble, 8000) << "8000 frames per second fill a bus of 1 Mbit/s";
  EXPECT_LE(health_.can_frames, imu_.frames()) << "the kernel keeps the rest away";
  ExpectNothingLostUncounted();
}

TEST_F(AgentOnABus, GoesOnAfterTheInterfaceWasDown) {
  imu_.RunFor(500ms);
  for (int i = 0; i < 3; ++i) {
    ASSERT_NO_FATAL_FAILURE(bus_.Switch(false));
    imu_.RunFor(200ms);  // into nothing
    ASSERT_NO_FATAL_FAILURE(bus_.Switch(true));
    ASSERT_NO_FATAL_FAILURE(NextHealth());
    const std::int64_t before = health_.imu_samples;
    imu_.RunFor(500ms);
    ASSERT_NO_FATAL_FAILURE(WaitForAllFrames());
    // The first group after the gap may be taken for a torn one.
    EXPECT_GE(health_.imu_samples - before, 200 - 10) << "data again at once";
  }
  EXPECT_EQ(health_.heap_calls, 0);
}

TEST_F(AgentOnABus, GoesOnAfterTheAdapterWasReplugged) {
  imu_.RunFor(200ms);
  ASSERT_EQ(std::system("ip link del vcan0"), 0);
  imu_.RunFor(200ms);  // into nothing
  // Another device in between, so that the interface gets another number.
  ASSERT_EQ(std::system("ip link add other0 type vcan; ip link add vcan0 type vcan; ip link set vcan0 up;"
                        "ip link del other0"),
            0);
  ASSERT_TRUE(bus_.Connect()) << std::strerror(errno);
  imu_.RunFor(1s);  // within which the agent has it again
  ASSERT_NO_FATAL_FAILURE(NextHealth());
  const std::int64_t before = health_.imu_samples;
  imu_.RunFor(500ms);
  ASSERT_NO_FATAL_FAILURE(NextHealth());
  EXPECT_GE(health_.imu_samples - before, 200 - 10);
  EXPECT_EQ(health_.heap_calls, 0);
}

TEST_F(AgentOnABus, GoesOnAfterBusOff) {
  const std::array<std::uint8_t, 8> data{};
  imu_.RunFor(500ms);
  error_frames_ += bus_.Send(CAN_ERR_FLAG | CAN_ERR_BUSOFF, data) ? 1 : 0;
  std::this_thread::sleep_for(300ms);
  error_frames_ += bus_.Send(CAN_ERR_FLAG | CAN_ERR_RESTARTED, data) ? 1 : 0;
  imu_.RunFor(500ms);
  ASSERT_NO_FATAL_FAILURE(WaitForAllFrames());
  ExpectNothingLostUncounted();  // and the two error frames are all that was refused
}

TEST_F(AgentOnABus, CountsExactlyWhatItsBufferLost) {
  imu_.RunFor(100ms);
  ::kill(agent_, SIGSTOP);
  for (int i = 0; i < 6000; ++i) imu_.Sample();  // 15 s of frames at once
  ::kill(agent_, SIGCONT);
  std::this_thread::sleep_for(200ms);
  imu_.RunFor(200ms);  // the kernel tells of a loss with the next frame
  ASSERT_NO_FATAL_FAILURE(WaitForAllFrames());
  EXPECT_GT(health_.kernel_drops, 0);
  EXPECT_EQ(health_.can_frames + health_.kernel_drops, imu_.frames());
  EXPECT_EQ(health_.heap_calls, 0);
}

TEST_F(AgentOnABus, RefusesAndCountsAMessageOfAnotherVersion) {
  mapweldlcm::request_t request{};
  request.agent_id = 7;
  request.epoch = 1;
  std::array<std::uint8_t, 1024> bytes{};
  const auto n = messages::Encode(request, bytes);
  ASSERT_TRUE(n.ok());
  for (const int flipped : {0, 1}) {
    ASSERT_NO_FATAL_FAILURE(NextHealth());
    const std::int64_t before = health_.bus_rejected;
    bytes[7] = static_cast<std::uint8_t>(bytes[7] ^ flipped);  // of the type's fingerprint
    ASSERT_EQ(lcm_->Publish("MW.7.REQUEST", std::span(bytes).first(n.value())), Status::kOk);
    ASSERT_NO_FATAL_FAILURE(NextHealth());
    EXPECT_EQ(health_.bus_rejected - before, flipped);
  }
}

TEST_F(AgentOnABus, EndsWhenToldTo) {
  imu_.RunFor(200ms);
  ::kill(agent_, SIGTERM);
  int status = -1;
  ASSERT_EQ(::waitpid(agent_, &status, 0), agent_);
  agent_ = -1;
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace mapweld

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (argc < 2) return 2;
  mapweld::agent_program = argv[1];
  return RUN_ALL_TESTS();
}
