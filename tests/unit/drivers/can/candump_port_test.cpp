// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/candump_port.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

#include "tests/support/temporary_directory.hpp"

namespace mapweld::can {
namespace {

class CandumpPortTest : public testing::Test {
 protected:
  void Write(const std::string& text) {
    std::ofstream(directory_.File("log"), std::ios::binary) << text;
    ASSERT_EQ(port_->Open(directory_.File("log").c_str(), interface_), Status::kOk);
  }
  static std::string Line(int i) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "(%d.%06d) can0 034#%08X\n", i / 1000, i % 1000 * 1000,
                  static_cast<unsigned>(i));
    return text.data();
  }
  static unsigned Value(const CanFrame& frame) {
    return (unsigned{frame.data[0]} << 24U) | (unsigned{frame.data[1]} << 16U) | (unsigned{frame.data[2]} << 8U) |
           frame.data[3];
  }

  test::TemporaryDirectory directory_;
  std::unique_ptr<CandumpPort> port_ = std::make_unique<CandumpPort>();
  std::string interface_;
  std::array<CanFrame, 16> out_{};
  std::size_t n_ = 0;
};

TEST_F(CandumpPortTest, GivesEveryFrameOfALogLargerThanItsBuffer) {
  std::string log;
  constexpr int kFrames = 5000;
  for (int i = 0; i < kFrames; ++i) log += Line(i);
  ASSERT_GT(log.size(), 4 * CandumpPort::kBufferBytes);
  Write(log);
  unsigned next = 0;
  while (port_->Receive(out_, &n_) == Status::kOk) {
    for (std::size_t i = 0; i < n_; ++i) ASSERT_EQ(Value(out_[i]), next++);
  }
  EXPECT_EQ(next, static_cast<unsigned>(kFrames));
  EXPECT_EQ(port_->counters().frames, static_cast<std::uint64_t>(kFrames));
  EXPECT_EQ(port_->counters().malformed, 0U);
  EXPECT_EQ(port_->Receive(out_, &n_), Status::kEmpty);
}

TEST_F(CandumpPortTest, StopsAtTheAskedTime) {
  Write(Line(1000) + Line(1001) + Line(1002) + Line(5000));
  ASSERT_EQ(port_->ReceiveUntil({1'001'000'000}, out_, &n_), Status::kOk);
  EXPECT_EQ(n_, 2U);
  ASSERT_EQ(port_->ReceiveUntil({1'001'000'000}, out_, &n_), Status::kOk);
  EXPECT_EQ(n_, 0U);
  TimeNs next;
  ASSERT_EQ(port_->NextTime(&next), Status::kOk);
  EXPECT_EQ(next.ns, 1'002'000'000);
  ASSERT_EQ(port_->ReceiveUntil({4'999'999'999}, out_, &n_), Status::kOk);
  EXPECT_EQ(n_, 1U);
  ASSERT_EQ(port_->ReceiveUntil({5'000'000'000}, out_, &n_), Status::kOk);
  EXPECT_EQ(n_, 1U);
  EXPECT_EQ(port_->NextTime(&next), Status::kEmpty);
}

TEST_F(CandumpPortTest, SkipsBadLinesAndCountsThem) {
  Write("garbage\n" + Line(1) + "\n" + std::string(100'000, 'x') + "\n" + Line(2) + "(1.5) can0 123##0AA\n" +
        std::string(300, '(') + "\n" + Line(3));
  ASSERT_EQ(port_->Receive(out_, &n_), Status::kOk);
  EXPECT_EQ(n_, 3U);
  EXPECT_EQ(port_->counters().malformed, 3U);
  EXPECT_EQ(port_->counters().can_fd, 1U);
}

TEST_F(CandumpPortTest, ReadsALastLineWithoutNewline) {
  std::string log = Line(1) + Line(2);
  log.pop_back();
  Write(log);
  ASSERT_EQ(port_->Receive(out_, &n_), Status::kOk);
  EXPECT_EQ(n_, 2U);
}

TEST_F(CandumpPortTest, TakesOnlyTheAskedInterface) {
  interface_ = "can1";
  Write(Line(1) + "(0.002000) can1 005#00000001\n" + "(0.003000) can10 005#00000001\n");
  ASSERT_EQ(port_->Receive(out_, &n_), Status::kOk);
  EXPECT_EQ(n_, 1U);
  EXPECT_EQ(port_->counters().other_interface, 2U);
}

TEST_F(CandumpPortTest, ReportsAMissingFile) {
  EXPECT_EQ(port_->Open(directory_.File("absent").c_str()), Status::kIo);
  EXPECT_EQ(port_->fd(), -1);
  EXPECT_EQ(port_->Receive(out_, &n_), Status::kIo);
}

TEST_F(CandumpPortTest, WaitsForTheRestOfALineInAPipe) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe2(ends.data(), O_NONBLOCK), 0);
  ASSERT_EQ(port_->Adopt(ends[0]), Status::kOk);
  const std::string line = Line(7);
  ASSERT_EQ(::write(ends[1], line.data(), 20), 20);
  ASSERT_EQ(port_->Receive(out_, &n_), Status::kOk);
  EXPECT_EQ(n_, 0U);
  ASSERT_EQ(::write(ends[1], line.data() + 20, line.size() - 20), static_cast<ssize_t>(line.size() - 20));
  ASSERT_EQ(port_->Receive(out_, &n_), Status::kOk);
  EXPECT_EQ(n_, 1U);
  ::close(ends[1]);
  EXPECT_EQ(port_->Receive(out_, &n_), Status::kEmpty);
}

}  // namespace
}  // namespace mapweld::can
