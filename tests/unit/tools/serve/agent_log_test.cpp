// SPDX-License-Identifier: Apache-2.0
// Logs as the simulator writes them, read as the merge reads them.
#include "tools/serve/agent_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/unit/tools/sim/test_folder.hpp"
#include "tools/sim/scenario.hpp"
#include "tools/sim/simulate.hpp"

namespace mapweld::serve {
namespace {

using sim::MessageOf;
using sim::ReadText;
using sim::WriteText;
using testing::HasSubstr;

class AgentLogs : public testing::Test {
 protected:
  // 20 s of one vehicle: it stands, then drives about 120 m.
  std::filesystem::path Simulate(const std::string& name) {
    sim::SimOptions options;
    options.scenario = sim::ScenarioByName("four_drives");
    options.out = folder_ / name;
    options.layout = sim::Layout::kSubmaps;
    options.seconds = 20;
    options.vehicles = {2};
    (void)sim::Simulate(options, [](int, double) {});
    return folder_ / (name + "/agent_2.lcm");
  }
  const sim::TestFolder folder_;
};

TEST_F(AgentLogs, HoldEveryKeyframeWithItsSubmap) {
  AgentLog log(Simulate("run"));
  ASSERT_EQ(log.drives().size(), 1U);
  const merge::Drive& drive = log.drives().front();
  EXPECT_EQ(drive.name, "agent_2");
  ASSERT_GT(drive.keyframes.size(), 15U);
  for (std::size_t k = 0; k < drive.keyframes.size(); ++k) {
    EXPECT_NEAR(drive.keyframes[k].path_m, 5.0 * static_cast<double>(k), 2.0);
    EXPECT_GT(drive.keyframes[k].place.descriptor.scale, 0);
    const auto cloud = log.Submap(0, static_cast<std::int32_t>(k));
    ASSERT_NE(cloud, nullptr);
    EXPECT_GT(cloud->points.size(), 3000U);
  }
  EXPECT_EQ(log.Submap(0, 1000), nullptr);
  EXPECT_EQ(log.refused(), 0U);
}

TEST_F(AgentLogs, AreTheSameBytesEveryTime) {
  EXPECT_TRUE(ReadText(Simulate("one")) == ReadText(Simulate("two")));
}

TEST_F(AgentLogs, KeepWhatCameBeforeTheyBreakOff) {
  const std::filesystem::path whole = Simulate("run");
  const AgentLog all(whole);
  const std::string bytes = ReadText(whole);
  const std::filesystem::path half = folder_ / "half.lcm";
  WriteText(half, bytes.substr(0, bytes.size() / 2));
  AgentLog log(half);
  EXPECT_EQ(log.drives().front().name, "half");
  const auto kept = static_cast<std::int32_t>(log.drives().front().keyframes.size());
  EXPECT_GT(kept, 5);
  EXPECT_LT(kept, static_cast<std::int32_t>(all.drives().front().keyframes.size()));
  EXPECT_NE(log.Submap(0, kept - 2), nullptr);
  EXPECT_EQ(log.Submap(0, kept - 1), nullptr) << "its last pieces are missing";
}

TEST_F(AgentLogs, PassOverFlippedBits) {
  std::string bytes = ReadText(Simulate("run"));
  for (std::size_t i = 1000; i < bytes.size(); i += 9973) bytes[i] = static_cast<char>(bytes[i] ^ 0x40);
  const std::filesystem::path broken = folder_ / "broken.lcm";
  WriteText(broken, bytes);
  AgentLog log(broken);
  for (std::size_t k = 0; k < log.drives().front().keyframes.size(); ++k) {
    (void)log.Submap(0, static_cast<std::int32_t>(k));  // null or a cloud, never a crash
  }
}

TEST_F(AgentLogs, NameTheFileThatIsNoLog) {
  EXPECT_THAT(MessageOf([&] { AgentLog log(folder_ / "none.lcm"); }), HasSubstr("none.lcm"));
  WriteText(folder_ / "text.lcm", "this is no log at all, and longer than a header of an event");
  EXPECT_THAT(MessageOf([&] { AgentLog log(folder_ / "text.lcm"); }), HasSubstr("holds no keyframes"));
}

}  // namespace
}  // namespace mapweld::serve
