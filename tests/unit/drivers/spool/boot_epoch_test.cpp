// SPDX-License-Identifier: Apache-2.0
#include "drivers/spool/boot_epoch.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temporary_directory.hpp"

namespace mapweld::spool {
namespace {

class BootEpoch : public testing::Test {
 protected:
  Result<std::int32_t> Next() const { return NextBootEpoch(directory_.path().c_str()); }
  void Write(const std::string& text) const { std::ofstream(directory_.File(kEpochFile), std::ios::binary) << text; }

  test::TemporaryDirectory directory_;
};

TEST_F(BootEpoch, CountsFromOneAndNeverRepeats) {
  for (std::int32_t expected = 1; expected <= 50; ++expected) {
    const Result<std::int32_t> epoch = Next();
    ASSERT_TRUE(epoch.ok());
    EXPECT_EQ(epoch.value(), expected);
  }
}

TEST_F(BootEpoch, SurvivesAPowerFailureDuringTheWrite) {
  Write("41\n");
  std::ofstream(directory_.File("epoch.new")) << "4";  // what a failure leaves behind
  EXPECT_EQ(Next().value(), 42);
}

TEST_F(BootEpoch, RefusesAFileThatHoldsNoCount) {
  for (const char* text : {"", "\n", "abc", "-3\n", "0\n", "12x\n", "12\n\n", " 12\n", "99999999999\n", "1 2\n",
                           "00000000000000000012\n"}) {
    Write(text);
    EXPECT_EQ(Next().status(), Status::kBadInput) << text;
  }
}

TEST_F(BootEpoch, StopsAtTheLastNumber) {
  Write("2147483646\n");
  EXPECT_EQ(Next().value(), 2147483647);
  EXPECT_EQ(Next().status(), Status::kOutOfRange);
}

TEST_F(BootEpoch, SaysWhenTheDirectoryIsMissing) {
  EXPECT_EQ(NextBootEpoch(directory_.File("absent").c_str()).status(), Status::kIo);
}

TEST_F(BootEpoch, GivesTwoProcessesDifferentNumbers) {
  std::vector<std::thread> threads;
  std::vector<std::vector<std::int32_t>> got(4);
  for (auto& mine : got) {
    threads.emplace_back([&] {
      for (int i = 0; i < 25; ++i) mine.push_back(Next().value());
    });
  }
  for (std::thread& thread : threads) thread.join();
  std::set<std::int32_t> all;
  for (const auto& mine : got) all.insert(mine.begin(), mine.end());
  EXPECT_EQ(all.size(), 100U);
}

}  // namespace
}  // namespace mapweld::spool
