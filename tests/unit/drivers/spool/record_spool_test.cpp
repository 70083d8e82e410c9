// SPDX-License-Identifier: Apache-2.0
#include "drivers/spool/record_spool.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
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

  void Open(std::int32_t epoch, std::uint64_t bytes = kFileBytes) {
    ASSERT_EQ(spool_->Open(path_.c_str(), bytes, epoch), Status::kOk) << std::strerror(errno);
  }
  void Reopen(std::int32_t epoch) {
    spool_ = std::make_unique<RecordSpool>();
    Open(epoch);
  }
  // The record, or nothing.
  Bytes Read(std::uint8_t kind, std::int32_t index) {
    Bytes out(1 << 18);
    const Result<std::size_t> bytes = spool_->Read(kind, index, out);
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
  Open(1);
  for (std::int32_t i = 0; i < 100; ++i) {
    ASSERT_EQ(spool_->Append(0, i, Content(i, 1300)), Status::kOk);
    ASSERT_EQ(spool_->Append(1, i, Content(-i, static_cast<std::size_t>(1 + i * 50))), Status::kOk);
  }
  for (std::int32_t i = 0; i < 100; ++i) {
    EXPECT_EQ(Read(0, i), Content(i, 1300));
    EXPECT_EQ(Read(1, i), Content(-i, static_cast<std::size_t>(1 + i * 50)));
  }
  EXPECT_EQ(spool_->size(), 200U);
  EXPECT_EQ(spool_->Read(2, 0, {}).status(), Status::kEmpty);
  EXPECT_EQ(spool_->Read(0, 100, {}).status(), Status::kEmpty);
  EXPECT_EQ(std::filesystem::file_size(path_), kFileBytes) << "never grows";
}

TEST_F(RecordSpoolTest, FindsItsRecordsAgainAfterARestartInTheSameEpoch) {
  Open(5);
  for (std::int32_t i = 0; i < 50; ++i) ASSERT_EQ(spool_->Append(0, i, Content(i, 777)), Status::kOk);
  ASSERT_EQ(spool_->Sync(), Status::kOk);
  Reopen(5);
  EXPECT_EQ(spool_->counters().recovered, 50U);
  for (std::int32_t i = 0; i < 50; ++i) EXPECT_EQ(Read(0, i), Content(i, 777));
  ASSERT_EQ(spool_->Append(0, 50, Content(50, 777)), Status::kOk);
  Reopen(5);
  EXPECT_EQ(spool_->size(), 51U);
}

TEST_F(RecordSpoolTest, StartsEmptyInANewEpoch) {
  Open(5);
  ASSERT_EQ(spool_->Append(0, 1, Content(1, 777)), Status::kOk);
  Reopen(6);
  EXPECT_EQ(spool_->size(), 0U);
  EXPECT_FALSE(spool_->Has(0, 1));
  Reopen(6);
  EXPECT_EQ(spool_->size(), 0U) << "old records never come back";
}

TEST_F(RecordSpoolTest, DropsTheNewcomerWhenTheFileIsFull) {
  Open(1, 10'000);
  std::int32_t appended = 0;
  while (spool_->Append(0, appended, Content(appended, 500)) == Status::kOk) ++appended;
  EXPECT_GT(appended, 15);
  EXPECT_EQ(spool_->Append(0, 1000, Content(0, 500)), Status::kFull);
  EXPECT_EQ(spool_->counters().full, 2U);
  for (std::int32_t i = 0; i < appended; ++i) EXPECT_EQ(Read(0, i), Content(i, 500));
  EXPECT_EQ(std::filesystem::file_size(path_), 10'000U);
}

TEST_F(RecordSpoolTest, DropsTheNewcomerWhenTheIndexIsFull) {
  Open(1, 64 << 20);
  const Bytes content(8, 1);
  for (std::size_t i = 0; i < kCap.spool_records; ++i) {
    ASSERT_EQ(spool_->Append(0, static_cast<std::int32_t>(i), content), Status::kOk);
  }
  EXPECT_EQ(spool_->Append(0, 1'000'000, content), Status::kFull);
  EXPECT_EQ(Read(0, 0), content);
}

TEST_F(RecordSpoolTest, GivesTheLatestOfARepeatedIndex) {
  Open(1);
  ASSERT_EQ(spool_->Append(0, 7, Content(1, 100)), Status::kOk);
  ASSERT_EQ(spool_->Append(0, 7, Content(2, 200)), Status::kOk);
  EXPECT_EQ(Read(0, 7), Content(2, 200));
}

TEST_F(RecordSpoolTest, LosesOnlyTheRecordThatAPowerFailureCut) {
  Open(1);
  for (std::int32_t i = 0; i < 10; ++i) ASSERT_EQ(spool_->Append(0, i, Content(i, 1000)), Status::kOk);
  spool_->Close();
  const std::uint64_t last = FileHeader::kBytes + 9 * RecordBytes(1000);
  FlipByte(last + RecordHeader::kBytes + 999);
  Reopen(1);
  EXPECT_EQ(spool_->size(), 9U);
  ASSERT_EQ(spool_->Append(0, 99, Content(99, 400)), Status::kOk) << "its place is used again";
  Reopen(1);
  EXPECT_EQ(spool_->size(), 10U);
  EXPECT_EQ(Read(0, 99), Content(99, 400));
}

TEST_F(RecordSpoolTest, NoticesEverySingleByteThatTheDiskChanged) {
  Open(1);
  ASSERT_EQ(spool_->Append(3, 5, Content(5, 40)), Status::kOk);
  Bytes out(64);
  for (std::uint64_t at = 0; at < RecordHeader::kBytes + 40; ++at) {
    FlipByte(FileHeader::kBytes + at);
    ASSERT_EQ(spool_->Read(3, 5, out).status(), Status::kCrc) << at;
    FlipByte(FileHeader::kBytes + at);
  }
  EXPECT_TRUE(spool_->Read(3, 5, out).ok());
}

TEST_F(RecordSpoolTest, StartsEmptyOverAFileThatIsNoSpool) {
  std::ofstream(path_) << std::string(5000, 'x');
  Open(1);
  EXPECT_EQ(spool_->size(), 0U);
  for (std::uint64_t at = 0; at < FileHeader::kBytes - 4; ++at) {
    ASSERT_EQ(spool_->Append(0, 1, Content(1, 10)), Status::kOk);
    spool_->Close();
    FlipByte(at);
    Reopen(1);
    ASSERT_EQ(spool_->size(), 0U) << "a damaged file header is not believed: byte " << at;
  }
}

TEST_F(RecordSpoolTest, BelongsToOneProcess) {
  Open(1);
  RecordSpool second;
  EXPECT_EQ(second.Open(path_.c_str(), kFileBytes, 1), Status::kIo);
  EXPECT_EQ(errno, EWOULDBLOCK);
}

TEST_F(RecordSpoolTest, RefusesSizesThatMakeNoSense) {
  EXPECT_EQ(spool_->Open(path_.c_str(), 10, 1), Status::kOutOfRange);
  EXPECT_EQ(spool_->Open(path_.c_str(), RecordSpool::kMaxFileBytes + 1, 1), Status::kOutOfRange);
  EXPECT_EQ(spool_->Open(directory_.File("a/b").c_str(), kFileBytes, 1), Status::kIo);
  EXPECT_EQ(spool_->Append(0, 0, Content(0, 10)), Status::kIo) << "not open";
  Open(1);
  EXPECT_EQ(spool_->Append(0, 0, {}), Status::kOutOfRange);
  ASSERT_EQ(spool_->Append(0, 0, Content(0, 10)), Status::kOk);
  Bytes small(9);
  EXPECT_EQ(spool_->Read(0, 0, small).status(), Status::kFull);
}

}  // namespace
}  // namespace mapweld::spool
