// SPDX-License-Identifier: Apache-2.0
// The power goes, or the disk fails, at every single write of a small run: the store opens, what was acknowledged is
// there, and the run goes on to the same end.
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/support/crash_disk.hpp"
#include "tests/support/small_city.hpp"
#include "tools/store/fsck.hpp"

namespace mapweld::store {
namespace {

using test::CrashDisk;
using test::SmallCity;
using test::Unsynced;

constexpr Unsynced kModes[] = {Unsynced::kLost, Unsynced::kKept, Unsynced::kReordered, Unsynced::kTorn};

// What was on the disk when a step was acknowledged.
struct Acknowledged {
  std::size_t operations = 0;
  Bytes digest;
};

// The whole run, closed once in the middle, which moves the log into the file.
std::vector<Acknowledged> FillCity(CrashDisk* disk) {
  std::vector<Acknowledged> acknowledged;
  const auto steps = SmallCity::Steps();
  const std::pair<std::size_t, std::size_t> halves[] = {{0, 5}, {5, steps.size()}};
  for (const auto& [from, to] : halves) {
    CityStore city("city.db", Database::Mode::kCreate, disk->vfs());
    for (std::size_t i = from; i < to; ++i) {
      steps[i](&city);
      acknowledged.push_back({disk->operations(), SmallCity::Digest(&city)});
    }
  }
  return acknowledged;
}

Bytes RunToTheEnd(const char* vfs) {
  CityStore city("city.db", Database::Mode::kCreate, vfs);
  for (const auto& step : SmallCity::Steps()) step(&city);
  return SmallCity::Digest(&city);
}

// Opens what the power cut left, and goes on. Acknowledged steps are a prefix of the run, so that the digest must be
// that of the last one acknowledged, or of the one that was being written.
void CheckRecovery(const CrashDisk::Files& files, const std::vector<Acknowledged>& run, std::size_t cut) {
  CrashDisk disk(files);
  {
    CityStore city("city.db", Database::Mode::kCreate, disk.vfs());
    const FsckReport report = Fsck(&city);
    ASSERT_TRUE(report.structure.empty()) << report.structure.front();
    ASSERT_TRUE(report.damaged.empty()) << report.damaged.front();
    const Bytes digest = SmallCity::Digest(&city);
    std::size_t last = 0;
    while (last < run.size() && run[last].operations <= cut) ++last;
    const Bytes nothing;
    const Bytes& durable = last == 0 ? nothing : run[last - 1].digest;
    ASSERT_TRUE(digest == durable || (last < run.size() && digest == run[last].digest))
        << "acknowledged steps: " << last;
  }
  ASSERT_TRUE(RunToTheEnd(disk.vfs()) == run.back().digest);
}

TEST(PowerCut, AtAnyWriteLosesNothingAcknowledged) {
  CrashDisk disk;
  const std::vector<Acknowledged> run = FillCity(&disk);
  int cuts = 0;
  for (std::size_t n = 0; n <= disk.operations(); ++n) {
    for (const Unsynced mode : kModes) {
      for (const std::uint32_t seed : {1U, 2U}) {
        if (seed == 2 && mode != Unsynced::kReordered && mode != Unsynced::kTorn)
          continue;  // nothing is left to chance
        CheckRecovery(disk.AfterCut(n, mode, seed), run, n);
        ASSERT_FALSE(HasFatalFailure()) << "cut after operation " << n << ", mode " << static_cast<int>(mode);
        ++cuts;
      }
    }
  }
  std::printf("%zu operations, %d power cuts\n", disk.operations(), cuts);
}

TEST(PowerCut, DuringTheRecoveryFromOneLosesNothingEither) {
  CrashDisk disk;
  const std::vector<Acknowledged> run = FillCity(&disk);
  int cuts = 0;
  for (std::size_t n = 0; n <= disk.operations(); n += 3) {
    const CrashDisk::Files left = disk.AfterCut(n, Unsynced::kReordered, 3);
    CrashDisk second(left);
    { CityStore city("city.db", Database::Mode::kCreate, second.vfs()); }
    for (std::size_t m = 0; m <= second.operations(); ++m) {
      for (const Unsynced mode : kModes) {
        CheckRecovery(second.AfterCut(m, mode, 4), run, n);
        ASSERT_FALSE(HasFatalFailure()) << "cut after operation " << n << ", again after " << m;
        ++cuts;
      }
    }
  }
  std::printf("%d power cuts during recovery\n", cuts);
}

// Does what the steps do as serve does it: a step that fails is tried again later, and nothing but it is lost.
void RunThroughFailures(CrashDisk* disk, std::vector<Bytes>* acknowledged) {
  const auto steps = SmallCity::Steps();
  std::size_t next = 0;
  for (int attempt = 0; attempt < 3 && next < steps.size(); ++attempt) {
    try {
      CityStore city("city.db", Database::Mode::kCreate, disk->vfs());
      for (int failures = 0; next < steps.size() && failures < 2;) {
        try {
          steps[next](&city);
          acknowledged->push_back(SmallCity::Digest(&city));
          ++next;
        } catch (const StoreError&) {
          ++failures;
        }
      }
    } catch (const StoreError&) {
      // It did not even open.
    }
  }
}

TEST(FailingDisk, AtAnyOperationKeepsWhatWasThereAndGoesOnWhenItWorksAgain) {
  CrashDisk whole;
  const std::vector<Acknowledged> run = FillCity(&whole);
  const Bytes& end = run.back().digest;
  int failures = 0;
  for (const int code : {SQLITE_FULL, SQLITE_IOERR_WRITE}) {
    for (const bool for_ever : {false, true}) {
      for (std::size_t n = 0;; ++n) {
        CrashDisk disk;
        disk.FailAt(n, code, for_ever);
        std::vector<Bytes> acknowledged;
        RunThroughFailures(&disk, &acknowledged);
        if (!disk.has_failed()) break;  // beyond the last operation
        ++failures;
        if (!for_ever) {
          ASSERT_TRUE(acknowledged.size() == SmallCity::Steps().size() && acknowledged.back() == end)
              << "operation " << n << " failed once with " << code;
        }
        // Another disk with the same bytes, that works.
        CrashDisk good(disk.files());
        if (!acknowledged.empty()) {
          CityStore city("city.db", Database::Mode::kExisting, good.vfs());
          ASSERT_TRUE(Fsck(&city).structure.empty()) << n;
          // A step whose commit was written but could not be synced was refused, and may be there all the same.
          const Bytes digest = SmallCity::Digest(&city);
          ASSERT_TRUE(digest == acknowledged.back() ||
                      (acknowledged.size() < run.size() && digest == run[acknowledged.size()].digest))
              << "operation " << n << " failed with " << code;
        }
        ASSERT_TRUE(RunToTheEnd(good.vfs()) == end) << n;
      }
    }
  }
  std::printf("%d failures\n", failures);
}

}  // namespace
}  // namespace mapweld::store
