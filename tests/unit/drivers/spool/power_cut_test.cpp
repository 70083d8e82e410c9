// SPDX-License-Identifier: Apache-2.0
// The power fails after every single thing that the spool asks of the disk, and what was not synced is lost, kept,
// reordered or torn: no record that Sync acknowledged may be missing, and none may ever read back wrong.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/spool/record_spool.hpp"
#include "tests/support/cut_power.hpp"
#include "tests/support/temporary_directory.hpp"

namespace {

using mapweld::test::DiskOperation;

std::vector<DiskOperation>* recording = nullptr;

void Record(DiskOperation operation) {
  if (recording != nullptr) recording->push_back(std::move(operation));
}

std::vector<std::uint8_t> Copy(const void* data, std::size_t bytes) {
  const auto* begin = static_cast<const std::uint8_t*>(data);
  return {begin, begin + bytes};
}

}  // namespace

// The calls of the spool, in place of the C library's.
extern "C" {
ssize_t pwrite(int fd, const void* data, std::size_t bytes, off_t at) {
  Record({DiskOperation::kWrite, static_cast<std::uint64_t>(at), Copy(data, bytes)});
  return ::syscall(SYS_pwrite64, fd, data, bytes, at);
}
ssize_t pwritev(int fd, const iovec* pieces, int n, off_t at) {
  DiskOperation whole{DiskOperation::kWrite, static_cast<std::uint64_t>(at), {}};
  for (const iovec& piece : std::span(pieces, static_cast<std::size_t>(n))) {
    const auto bytes = Copy(piece.iov_base, piece.iov_len);
    whole.bytes.insert(whole.bytes.end(), bytes.begin(), bytes.end());
  }
  const ssize_t written = ::syscall(SYS_pwrite64, fd, whole.bytes.data(), whole.bytes.size(), at);
  Record(std::move(whole));
  return written;
}
int ftruncate(int fd, off_t size) noexcept {
  Record({DiskOperation::kTruncate, static_cast<std::uint64_t>(size), {}});
  return static_cast<int>(::syscall(SYS_ftruncate, fd, size));
}
int posix_fallocate(int fd, off_t at, off_t size) {
  Record({DiskOperation::kTruncate, static_cast<std::uint64_t>(at + size), {}});
  return ::syscall(SYS_fallocate, fd, 0, at, size) == 0 ? 0 : errno;
}
int fsync(int fd) {
  Record({DiskOperation::kSync, 0, {}});
  return static_cast<int>(::syscall(SYS_fsync, fd));
}
int fdatasync(int fd) {
  Record({DiskOperation::kSync, 0, {}});
  return static_cast<int>(::syscall(SYS_fdatasync, fd));
}
}

namespace mapweld::spool {
namespace {

using Bytes = std::vector<std::uint8_t>;
using test::Unsynced;

constexpr std::uint64_t kFileBytes = 32 << 10;  // four segments of some five records each
constexpr std::int32_t kRecords = 28;           // more than fit: the last segment is the first one again

Bytes Content(std::int32_t index) {
  Bytes out(static_cast<std::size_t>(1 + index * 397 % 3000));
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<std::uint8_t>(i * 13 + 7 + static_cast<std::size_t>(index));
  return out;
}

// Records of several boots.
RecordSpool::Key KeyOf(std::int32_t index) {
  return {.epoch = 1 + index / 8, .kind = 0, .index = index};
}

class PowerCut : public testing::TestWithParam<Unsynced> {
 protected:
  // Opens, appends and syncs now and then; remembers after how many operations each record was acknowledged.
  void SetUp() override {
    auto spool = std::make_unique<RecordSpool>();
    recording = &operations_;
    ASSERT_EQ(spool->Open(path_.c_str(), kFileBytes), Status::kOk);
    std::int32_t unsynced = 0;
    for (std::int32_t index = 0; index < kRecords; ++index) {
      const std::size_t before = operations_.size();
      ASSERT_EQ(spool->Append(KeyOf(index), Content(index)), Status::kOk);
      // The oldest give way from the moment at which the first thing is asked of the disk for it.
      for (std::int32_t old = 0; old < index; ++old) {
        if (!spool->Has(KeyOf(old)) && !given_up_after_.contains(old)) given_up_after_[old] = before;
      }
      if (index % 3 != 2) continue;
      ASSERT_EQ(spool->Sync(), Status::kOk);
      for (; unsynced <= index; ++unsynced) acknowledged_after_[unsynced] = operations_.size();
    }
    recording = nullptr;
    ASSERT_FALSE(given_up_after_.empty());
  }
  void RequireGood(const RecordSpool& spool, std::size_t cut) {
    for (const auto& [index, after] : acknowledged_after_) {
      const bool given_up = given_up_after_.contains(index) && given_up_after_[index] < cut;
      ASSERT_TRUE(after > cut || given_up || spool.Has(KeyOf(index))) << "record " << index << " of cut " << cut;
    }
  }
  void RequireRight(RecordSpool* spool) {
    Bytes out(4096);
    for (std::int32_t index = 0; index < 100; ++index) {
      if (!spool->Has(KeyOf(index))) continue;
      const auto got = spool->Read(KeyOf(index), out);
      ASSERT_TRUE(got.ok()) << index;
      ASSERT_EQ(Bytes(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(got.value())), Content(index));
    }
  }

  test::TemporaryDirectory directory_;
  std::string path_ = directory_.File("spool");
  std::vector<DiskOperation> operations_;
  std::map<std::int32_t, std::size_t> acknowledged_after_;
  std::map<std::int32_t, std::size_t> given_up_after_;
};

TEST_P(PowerCut, LosesNoAcknowledgedRecordAndInventsNone) {
  ASSERT_GE(operations_.size(), 40U) << "the calls of the spool are seen";
  int cuts = 0;
  for (std::size_t cut = 0; cut <= operations_.size(); ++cut) {
    for (std::uint32_t seed = 0; seed < 20; ++seed, ++cuts) {
      const Bytes disk = test::AfterPowerCut(operations_, cut, GetParam(), seed);
      std::ofstream(path_, std::ios::binary)
          .write(reinterpret_cast<const char*>(disk.data()), static_cast<std::streamsize>(disk.size()));
      auto spool = std::make_unique<RecordSpool>();
      ASSERT_EQ(spool->Open(path_.c_str(), kFileBytes), Status::kOk);
      ASSERT_NO_FATAL_FAILURE(RequireGood(*spool, cut));
      ASSERT_NO_FATAL_FAILURE(RequireRight(spool.get()));
      // It goes on from there, and the next start finds that too.
      ASSERT_EQ(spool->Append(KeyOf(99), Content(99)), Status::kOk);
      const bool spool_was_roomy = spool->counters().given_up == 0;
      spool = std::make_unique<RecordSpool>();
      ASSERT_EQ(spool->Open(path_.c_str(), kFileBytes), Status::kOk);
      ASSERT_TRUE(spool->Has(KeyOf(99)));
      if (spool_was_roomy) {
        ASSERT_NO_FATAL_FAILURE(RequireGood(*spool, cut));
      }
      ASSERT_NO_FATAL_FAILURE(RequireRight(spool.get()));
    }
  }
  std::printf("%zu operations, %d power cuts\n", operations_.size(), cuts);
}

std::string NameOf(const testing::TestParamInfo<Unsynced>& mode) {
  constexpr std::array kNames{"Lost", "Kept", "Reordered", "Torn"};
  return kNames[static_cast<std::size_t>(mode.param)];
}

INSTANTIATE_TEST_SUITE_P(Unsynced, PowerCut,
                         testing::Values(Unsynced::kLost, Unsynced::kKept, Unsynced::kReordered, Unsynced::kTorn),
                         NameOf);

}  // namespace
}  // namespace mapweld::spool
