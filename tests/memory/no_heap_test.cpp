// SPDX-License-Identifier: Apache-2.0
// A drive through a small synthetic street with the heap sealed: not one call to the allocator.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <memory>

#include "core/pipeline/agent_pipeline.hpp"
#include "firmware-like/heap_seal.hpp"
#include "tests/support/street_drive.hpp"

namespace mapweld {
namespace {

struct CountingSink final : pipeline::AgentSink {
  void OnPose(const pipeline::PoseOutput&) override { ++poses; }
  void OnKeyframe(const pipeline::KeyframeOutput&) override { ++keyframes; }
  std::uint64_t poses = 0;
  int keyframes = 0;
};

// Pages of memory that are in use, without a call to the allocator.
long ResidentPages() {
  char text[128] = {};
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  const ssize_t n = read(file, text, sizeof(text) - 1);
  close(file);
  long size = 0;
  long resident = 0;
  if (n > 0) sscanf(text, "%ld %ld", &size, &resident);
  return resident;
}

// tests/memory/hour_replay makes it an hour.
TEST(Heap, IsNotTouchedByAWholeDrive) {
  const char* asked = std::getenv("MAPWELD_REPLAY_SECONDS");
  const double seconds = asked != nullptr ? std::strtod(asked, nullptr) : 40;
  auto street = std::make_unique<test::StreetDrive>(test::StreetDriveConfig{.seconds = seconds});
  CountingSink sink;
  auto agent = std::make_unique<pipeline::AgentPipeline>(pipeline::AgentConfig{}, &sink);
  constexpr int kPacketsPerSecond = 750;

  ASSERT_GE(executive::HeapCallsAfterSeal(), 0) << "the interposer is not linked";
  executive::SealHeap(false);
  for (int i = 0; i < 30 * kPacketsPerSecond; ++i) street->Step(agent.get());  // until submaps flow and the maps fill
  const long pages = ResidentPages();
  int packets = 0;
  while (street->Step(agent.get())) {
    if (++packets % (300 * kPacketsPerSecond) != 0) continue;
    std::printf("%d s: %ld pages, %lld heap calls\n", packets / kPacketsPerSecond + 30, ResidentPages(),
                static_cast<long long>(executive::HeapCallsAfterSeal()));
  }
  const long grown = ResidentPages() - pages;
  agent->OnDriveEnd();
  const std::int64_t calls = executive::HeapCallsAfterSeal();

  EXPECT_EQ(calls, 0);
  EXPECT_EQ(sink.poses, agent->counters().scans);
  EXPECT_GT(sink.poses, 8 * seconds);
  EXPECT_GT(sink.keyframes, seconds);
  std::printf("%.0f s, %.1f km: %lld heap calls, %ld pages more than after 30 s\n", seconds, 1e-3 * agent->path_m(),
              static_cast<long long>(calls), grown);
  auto probe = std::make_unique<int>(1);  // the seal itself works
  EXPECT_GT(executive::HeapCallsAfterSeal(), calls);
}

}  // namespace
}  // namespace mapweld
