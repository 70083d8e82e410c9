// SPDX-License-Identifier: Apache-2.0
#include "drivers/spool/record_spool.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/temporary_directory.hpp"

namespace mapweld::spool {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes Content(std::int32_t index, std::size_t bytes) {
  Bytes out(bytes);
  for (std::size_t i = 0; i < bytes; ++i) out[i] = static_cast<std::uint8_t>(i * 13 + static_cast<std::size_t>(index));
  return out;
}

class RecordSpoolTest : public testing::Test {
 protected:
  static constexpr std::uint64_t kFileBytes = 1 << 20;

  void Open(std::uint64_t bytes = kFileBytes) {
    ASSERT_EQ(spool_->Open(path_.c_str(), bytes), Status::kOk) << std::strerror(errno);
  }
  void Reopen(std::uint64_t bytes = kFileBytes) {
    spool_ = std::make_unique<RecordSpool>();
    Open(bytes);
  }
  Status Append(std::uint8_t kind, std::int32_t index, const Bytes& content, std::int32_t epoch = 1) {
    return spool_->Append({epoch, kind, index}, content);
  }
  bool Has(std::uint8_t kind, std::int32_t index, std::int32_t epoch = 1) const {
    return spool_->Has({epoch, kind, index});
  }
  // The record, or nothing.
  Bytes Read(std::uint8_t kind, std::int32_t index, std::int32_t epoch = 1) {
    Bytes out(1 << 18);
    const Result<std::size_t> bytes = spool_->Read({epoch, kind, index}, out);
    out.resize(bytes.ok() ? bytes.value() : 0);
    return out;
  }
  void FlipByte(std::uint64_t at) const {
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(static_cast<std::streamoff>(at));
    const char byte = static_cast<char>(file.get() ^ 1);
    file.seekp(static_cast<std::streamoff>(at));
    file.put(byte);
  }

  test::TemporaryDirectory directory_;
  std::string path_ = directory_.File("spool");
  std::unique_ptr<RecordSpool> spool_ = std::make_unique<RecordSpool>();
};

TEST_F(RecordSpoolTest, GivesBackWhatWasAppended) {
  Open();
  for (std::int32_t i = 0; i < 100; ++i) {
    ASSERT_EQ(Append(0, i, Content(i, 1300)), Status::kOk);
    ASSERT_EQ(Append(1, i, Content(-i, static_cast<std::size_t>(1 + i * 50))), Status::kOk);
  }
  for (std::int32_t i = 0; i < 100; ++i) {
    EXPECT_EQ(Read(0, i), Content(i, 1300));
    EXPECT_EQ(Read(1, i), Content(-i, static_cast<std::size_t>(1 + i * 50)));
  }
  EXPECT_EQ(spool_->size(), 200U);
  EXPECT_EQ(spool_->Read({1, 2, 0}, {}).status(), Status::kEmpty);
  EXPECT_EQ(spool_->Read({1, 0, 100}, {}).status(), Status::kEmpty);
  EXPECT_EQ(std::filesystem::file_size(path_), kFileBytes) << "never grows";
}

TEST_F(RecordSpoolTest, FindsTheRecordsOfEveryBootAgain) {
  for (std::int32_t epoch = 1; epoch <= 5; ++epoch) {
    Reopen();
    EXPECT_EQ(spool_->counters().recovered, static_cast<std::uint64_t>(50 * (epoch - 1)));
    for (std::int32_t i = 0; i < 50; ++i) ASSERT_EQ(Append(0, i, Content(i + epoch, 777), epoch), Status::kOk);
  }
  ASSERT_EQ(spool_->Sync(), Status::kOk);
  Reopen();
  for (std::int32_t epoch = 1; epoch <= 5; ++epoch) {
    for (std::int32_t i = 0; i < 50; ++i) EXPECT_EQ(Read(0, i, epoch), Content(i + epoch, 777));
  }
  EXPECT_FALSE(Has(0, 0, 6));
  EXPECT_FALSE(Has(1, 0, 5));
}

TEST_F(RecordSpoolTest, KnowsTheLastRecordOfEachEarlierBoot) {
  Open();
  for (const auto& [epoch, last] : {std::pair(2, 7), {4, 3}, {5, 9}}) {
    for (std::int32_t i = 0; i <= last; ++i) ASSERT_EQ(Append(0, i, Content(i, 10), epoch), Status::kOk);
    ASSERT_EQ(Append(1, 100, Content(0, 10), epoch), Status::kOk) << "of another kind";
  }
  RecordSpool::Key last;
  ASSERT_EQ(spool_->LastBefore(5, 0, &last), Status::kOk);
  EXPECT_EQ(last, (RecordSpool::Key{4, 0, 3}));
  ASSERT_EQ(spool_->LastBefore(last.epoch, 0, &last), Status::kOk);
  EXPECT_EQ(last, (RecordSpool::Key{2, 0, 7}));
  EXPECT_EQ(spool_->LastBefore(last.epoch, 0, &last), Status::kEmpty);
}

TEST_F(RecordSpoolTest, GivesUpTheOldestQuarterWhenTheFileIsFull) {
  constexpr std::uint64_t kSmall = 40'000;
  Open(kSmall);
  std::int32_t appended = 0;
  for (int round = 0; round < 3; ++round) {
    const std::uint64_t before = spool_->counters().given_up;
    while (spool_->counters().given_up == before) {
      ASSERT_EQ(Append(0, appended, Content(appended, 500)), Status::kOk);
      ++appended;
    }
    const auto first = static_cast<std::int32_t>(spool_->counters().given_up);
    for (std::int32_t i = 0; i < appended; ++i) {
      ASSERT_EQ(Read(0, i), i < first ? Bytes() : Content(i, 500)) << i << " of " << appended;
    }
    EXPECT_GE(static_cast<std::uint64_t>(appended - first) * RecordBytes(500), kSmall / 4 * 3 - 4 * RecordBytes(500));
    // And so it stays over a restart.
    spool_->Close();
    const std::uint64_t given_up = spool_->counters().given_up;
    Open(kSmall);
    ASSERT_EQ(spool_->counters().given_up, given_up);
    for (std::int32_t i = 0; i < appended; ++i) ASSERT_EQ(Has(0, i), i >= first) << i;
  }
  EXPECT_EQ(std::filesystem::file_size(path_), kSmall);
}

TEST_F(RecordSpoolTest, DropsANewcomerThatIsLargerThanAQuarter) {
  Open(40'000);
  ASSERT_EQ(Append(0, 1, Content(1, 500)), Status::kOk);
  EXPECT_EQ(Append(0, 2, Content(2, 10'000)), Status::kFull);
  EXPECT_EQ(spool_->counters().full, 1U);
  EXPECT_EQ(Read(0, 1), Content(1, 500));
}

TEST_F(RecordSpoolTest, GivesUpTheOldestQuarterWhenTheIndexIsFull) {
  const Bytes content(96, 1);
  const std::uint64_t index_fills = kCap.spool_records * RecordBytes(content.size());
  Open(2 * index_fills);
  for (std::size_t i = 0; i < 2 * kCap.spool_records; ++i) {
    ASSERT_EQ(Append(0, static_cast<std::int32_t>(i), content), Status::kOk) << i;
    ASSERT_EQ(spool_->counters().given_up > 0, i >= kCap.spool_records) << i;
  }
  EXPECT_TRUE(Has(0, static_cast<std::int32_t>(2 * kCap.spool_records - 1)));
}

TEST_F(RecordSpoolTest, DropsTheNewcomerWhenOneQuarterAloneFillsTheIndex) {
  const Bytes content(96, 1);
  Open(8 * kCap.spool_records * RecordBytes(content.size()));
  for (std::size_t i = 0; i < kCap.spool_records; ++i) {
    ASSERT_EQ(Append(0, static_cast<std::int32_t>(i), content), Status::kOk);
  }
  EXPECT_EQ(Append(0, 1'000'000, content), Status::kFull);
  EXPECT_EQ(spool_->counters().full, 1U);
  EXPECT_EQ(spool_->counters().given_up, 0U);
}

TEST_F(RecordSpoolTest, GivesTheLatestOfARepeatedIndex) {
  Open();
  ASSERT_EQ(Append(0, 7, Content(1, 100)), Status::kOk);
  ASSERT_EQ(Append(0, 7, Content(2, 200)), Status::kOk);
  EXPECT_EQ(Read(0, 7), Content(2, 200));
}

TEST_F(RecordSpoolTest, LosesOnlyTheRecordThatAPowerFailureCut) {
  Open();
  for (std::int32_t i = 0; i < 10; ++i) ASSERT_EQ(Append(0, i, Content(i, 1000)), Status::kOk);
  spool_->Close();
  const std::uint64_t last = SegmentHeader::kBytes + 9 * RecordBytes(1000);
  FlipByte(last + RecordHeader::kBytes + 999);
  Reopen();
  EXPECT_EQ(spool_->size(), 9U);
  ASSERT_EQ(Append(0, 99, Content(99, 400)), Status::kOk) << "its place is used again";
  Reopen();
  EXPECT_EQ(spool_->size(), 10U);
  EXPECT_EQ(Read(0, 99), Content(99, 400));
}

TEST_F(RecordSpoolTest, NoticesEverySingleByteThatTheDiskChanged) {
  Open();
  ASSERT_EQ(Append(3, 5, Content(5, 40)), Status::kOk);
  Bytes out(64);
  for (std::uint64_t at = 0; at < RecordHeader::kBytes + 40; ++at) {
    FlipByte(SegmentHeader::kBytes + at);
    ASSERT_EQ(spool_->Read({1, 3, 5}, out).status(), Status::kCrc) << at;
    FlipByte(SegmentHeader::kBytes + at);
  }
  EXPECT_TRUE(spool_->Read({1, 3, 5}, out).ok());
}

TEST_F(RecordSpoolTest, StartsEmptyOverAFileThatIsNoSpoolOrOfAnotherSize) {
  std::ofstream(path_) << std::string(5000, 'x');
  Open();
  EXPECT_EQ(spool_->size(), 0U);
  for (std::uint64_t at = 0; at < SegmentHeader::kBytes - 4; ++at) {
    ASSERT_EQ(Append(0, 1, Content(1, 10)), Status::kOk);
    spool_->Close();
    FlipByte(at);
    Reopen();
    ASSERT_EQ(spool_->size(), 0U) << "a damaged header is not believed: byte " << at;
  }
  ASSERT_EQ(Append(0, 1, Content(1, 10)), Status::kOk);
  Reopen(2 * kFileBytes);
  EXPECT_EQ(spool_->size(), 0U);
}

TEST_F(RecordSpoolTest, BelongsToOneProcess) {
  Open();
  RecordSpool second;
  EXPECT_EQ(second.Open(path_.c_str(), kFileBytes), Status::kIo);
  EXPECT_EQ(errno, EWOULDBLOCK);
}

TEST_F(RecordSpoolTest, RefusesSizesThatMakeNoSense) {
  EXPECT_EQ(spool_->Open(path_.c_str(), 10), Status::kOutOfRange);
  EXPECT_EQ(spool_->Open(path_.c_str(), RecordSpool::kMaxFileBytes + 1), Status::kOutOfRange);
  EXPECT_EQ(spool_->Open(directory_.File("a/b").c_str(), kFileBytes), Status::kIo);
  EXPECT_EQ(Append(0, 0, Content(0, 10)), Status::kIo) << "not open";
  Open();
  EXPECT_EQ(Append(0, 0, {}), Status::kOutOfRange);
  ASSERT_EQ(Append(0, 0, Content(0, 10)), Status::kOk);
  Bytes small(9);
  EXPECT_EQ(spool_->Read({1, 0, 0}, small).status(), Status::kFull);
}

}  // namespace
}  // namespace mapweld::spool
