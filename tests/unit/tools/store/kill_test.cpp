// SPDX-License-Identifier: Apache-2.0
// A process that fills a store is killed at random moments, again and again, on a real disk: each time the store opens
// and holds everything that the process had acknowledged, and the end is that of a run that nobody disturbed.
// 40 times; MAPWELD_STORE_KILLS=1000 for a night.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <random>

#include "tests/support/small_city.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tools/store/fsck.hpp"

namespace mapweld::store {
namespace {

constexpr std::int32_t kEnough = 1 << 20;

std::int32_t Count(CityStore* city, DriveKey drive) {
  return static_cast<std::int32_t>(
      city->database().Keys(Table::kKeyframes, PairKey(drive, 0), PairKey(drive, kEnough)).size());
}

// Goes on where the store is, keyframe by keyframe, and says on the pipe how many are acknowledged.
[[noreturn]] void Fill(const std::string& path, int pipe) {
  try {
    CityStore city(path);
    const auto known = city.FindDrive("agent_1");
    DriveInfo info;
    info.name = "agent_1";
    const DriveKey drive = known.has_value() ? known->key : city.AddDrive(info);
    for (std::int32_t k = Count(&city, drive);; ++k) {
      city.Write([&] {
        city.AddKeyframe(drive, k, test::SmallKeyframe(0, k));
        city.AddSubmap(drive, k, Encode(test::SmallSubmap(0, k)));
      });
      const std::int32_t acknowledged = k + 1;
      if (::write(pipe, &acknowledged, sizeof(acknowledged)) != sizeof(acknowledged)) ::_exit(1);
    }
  } catch (const std::exception&) {
    ::_exit(1);
  }
}

TEST(Kill, AtAnyMomentLosesNothingAcknowledged) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.File("city.db");
  const char* wanted = std::getenv("MAPWELD_STORE_KILLS");
  const int kills = wanted != nullptr ? std::atoi(wanted) : 40;
  std::mt19937 random(1);
  std::int32_t acknowledged = 0;
  // On a busy machine a process may be killed before it has done anything: some more, then.
  for (int i = 0; i < kills || (acknowledged < kills && i < 20 * kills); ++i) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const pid_t child = ::fork();
    if (child == 0) Fill(path, ends[1]);
    ::close(ends[1]);
    ::usleep(static_cast<useconds_t>(random() % 40'000));
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the child ended by itself: it could not use the store";
    for (std::int32_t said = 0; ::read(ends[0], &said, sizeof(said)) == sizeof(said);) acknowledged = said;
    ::close(ends[0]);
    CityStore city(path);
    const FsckReport report = Fsck(&city);
    ASSERT_TRUE(report.Clean()) << ToText(report, path);
    ASSERT_GE(report.keyframes, acknowledged) << "after kill " << i;
    ASSERT_LE(report.keyframes, acknowledged + 1) << "more than one keyframe was on its way";
    ASSERT_EQ(report.keyframes, report.submaps);
    acknowledged = static_cast<std::int32_t>(
        report.keyframes);  // the one on its way was written: the next process goes on behind it
  }
  CityStore city(path);
  const auto keyframes = city.Keyframes(1);
  for (const auto& [k, keyframe] : keyframes) {
    ASSERT_EQ(Encode(keyframe), Encode(test::SmallKeyframe(0, k)));
    ASSERT_TRUE(city.Submap(1, k)->points == test::SmallSubmap(0, k).points);
  }
  std::printf("%d kills, %d keyframes acknowledged, %zu there\n", kills, acknowledged, keyframes.size());
}

}  // namespace
}  // namespace mapweld::store
