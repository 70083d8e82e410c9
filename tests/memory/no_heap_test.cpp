// SPDX-License-Identifier: Apache-2.0
// A drive through a small synthetic street with the heap sealed: not one call to the allocator.
#include <gtest/gtest.h>

#include <memory>

#include "core/pipeline/agent_pipeline.hpp"
#include "firmware-like/heap_seal.hpp"
#include "tests/support/street_drive.hpp"

namespace mapweld {
namespace {

struct CountingSink final : pipeline::AgentSink {
  void OnPose(const pipeline::PoseOutput&) override { ++poses; }
  void OnKeyframe(const pipeline::KeyframeOutput&) override { ++keyframes; }
  int poses = 0;
  int keyframes = 0;
};

TEST(Heap, IsNotTouchedByAWholeDrive) {
  auto street = std::make_unique<test::StreetDrive>();
  CountingSink sink;
  auto agent = std::make_unique<pipeline::AgentPipeline>(pipeline::AgentConfig{}, &sink);

  ASSERT_GE(executive::HeapCallsAfterSeal(), 0) << "the interposer is not linked";
  executive::SealHeap(false);
  while (street->Step(agent.get())) {
  }
  agent->OnDriveEnd();
  const std::int64_t calls = executive::HeapCallsAfterSeal();

  EXPECT_EQ(calls, 0);
  EXPECT_GT(sink.poses, 100);
  EXPECT_GT(sink.keyframes, 20);
  auto probe = std::make_unique<int>(1);  // the seal itself works
  EXPECT_GT(executive::HeapCallsAfterSeal(), calls);
}

}  // namespace
}  // namespace mapweld
