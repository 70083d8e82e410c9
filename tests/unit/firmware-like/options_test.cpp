// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace mapweld::executive {
namespace {

using testing::HasSubstr;

ParsedOptions Parse(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "mapweld-agent");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ParsedOptions parsed = ParseOptions(static_cast<int>(arguments.size()), argv.data());
  parsed.options.state_dir = nullptr;  // pointed into `arguments`
  parsed.options.can_interface = nullptr;
  parsed.options.candump_path = nullptr;
  return parsed;
}

TEST(Options, AcceptTheUsualCommandLine) {
  const auto parsed = Parse({"--agent-id", "3", "--state-dir", "/tmp", "--can", "can0", "--lidar-port", "2370",
                             "--time", "receive", "--lidar-at", "1,2,3,0,0,90"});
  ASSERT_EQ(parsed.outcome, ParseOutcome::kRun) << parsed.message;
  EXPECT_EQ(parsed.options.agent_id, 3);
  EXPECT_EQ(parsed.options.lidar_port, 2370);
  EXPECT_EQ(parsed.options.time_source, TimeSource::kReceive);
  const auto p_body = parsed.options.agent.lio.body_T_lidar * geom::Vec3d(1, 0, 0);
  EXPECT_LT((p_body - geom::Vec3d(1, 3, 3)).norm(), 1e-12);
}

TEST(Options, KnowTheLidarModelsAndWhichNeedACalibration) {
  const std::vector<std::string> good = {"--agent-id", "3", "--state-dir", "/tmp", "--can", "can0"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), good.begin(), good.end());
    return Parse(more);
  };
  EXPECT_EQ(with({}).options.lidar_model, LidarModel::kVlp16);
  EXPECT_EQ(with({}).options.lidar_port, 2368);
  EXPECT_EQ(with({"--lidar", "vlp32c"}).options.lidar_model, LidarModel::kVlp32c);
  EXPECT_EQ(with({"--lidar", "xt32", "--lidar-calibration", "a.csv"}).outcome, ParseOutcome::kRun);
  EXPECT_EQ(with({"--lidar", "os1", "--lidar-calibration", "a.json"}).options.lidar_port, 7502);
  EXPECT_THAT(with({"--lidar", "os1"}).message, HasSubstr("needs --lidar-calibration"));
  EXPECT_THAT(with({"--lidar", "vlp16", "--lidar-calibration", "a"}).message, HasSubstr("os1 and xt32 only"));
}

TEST(Options, TakeAnotherImuOnlyWithItsSignalsAndAFreeClock) {
  const std::vector<std::string> good = {"--agent-id", "3", "--state-dir", "/tmp", "--can", "can0"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), good.begin(), good.end());
    return Parse(more);
  };
  EXPECT_EQ(with({"--imu-dbc", "a.dbc", "--imu-signals", "a,b,c,d,e,f", "--time", "receive"}).outcome,
            ParseOutcome::kRun);
  EXPECT_THAT(with({"--imu-dbc", "a.dbc", "--time", "receive"}).message, HasSubstr("go together"));
  EXPECT_THAT(with({"--imu-dbc", "a.dbc", "--imu-signals", "a,b,c,d,e,f"}).message, HasSubstr("--time receive"));
}

TEST(Options, TakeTheIdentifiersOfAnMti) {
  const std::vector<std::string> good = {"--agent-id", "3", "--state-dir", "/tmp", "--can", "can0", "--imu-ids"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), good.begin(), good.end());
    return Parse(more);
  };
  const auto parsed = with({"005,006,011,061,062"});
  EXPECT_EQ(parsed.outcome, ParseOutcome::kRun);
  EXPECT_EQ(parsed.options.imu_ids.all()[3], 0x061U);
  EXPECT_THAT(with({"005,006"}).message, HasSubstr("--imu-ids does not accept '005,006'"));
  EXPECT_THAT(
      with({"005,006,011,061,062", "--imu-dbc", "a", "--imu-signals", "a,b,c,d,e,f", "--time", "receive"}).message,
      HasSubstr("--imu-ids is for an MTi"));
}

TEST(Options, SayWhichValueIsWrong) {
  const std::vector<std::string> good = {"--agent-id", "3", "--state-dir", "/tmp", "--can", "can0"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), good.begin(), good.end());
    return Parse(more);
  };
  for (const auto& [option, value] : std::vector<std::pair<std::string, std::string>>{{"--agent-id", "0"},
                                                                                      {"--agent-id", "x"},
                                                                                      {"--agent-id", "99999"},
                                                                                      {"--lidar-port", "70000"},
                                                                                      {"--lidar", "hdl64e"},
                                                                                      {"--time", "gps"},
                                                                                      {"--lidar-at", "1,2,3"},
                                                                                      {"--lidar-at", "1,2,3,4,5,6,7"},
                                                                                      {"--spool-mib", "-1"},
                                                                                      {"--answer-rate", "1e6"}}) {
    const auto parsed = with({option, value});
    EXPECT_EQ(parsed.outcome, ParseOutcome::kError) << option << " " << value;
    EXPECT_THAT(parsed.message, HasSubstr(option));
    EXPECT_THAT(parsed.message, HasSubstr(value));
  }
}

TEST(Options, SayWhatIsMissingOrUnknown) {
  EXPECT_THAT(Parse({"--state-dir", "/tmp", "--can", "can0"}).message, HasSubstr("--agent-id"));
  EXPECT_THAT(Parse({"--agent-id", "1", "--can", "can0"}).message, HasSubstr("--state-dir"));
  EXPECT_THAT(Parse({"--agent-id", "1", "--state-dir", "/tmp"}).message, HasSubstr("--can, --candump"));
  EXPECT_THAT(Parse({"--agent-id", "1", "--state-dir", "/tmp", "--can", "a", "--candump", "b"}).message,
              HasSubstr("one of them"));
  EXPECT_THAT(Parse({"--fly"}).message, HasSubstr("--fly"));
  EXPECT_THAT(Parse({"stray"}).message, HasSubstr("stray"));
}

TEST(Options, HelpAndVersionNeedNothingElse) {
  EXPECT_EQ(Parse({"--help"}).outcome, ParseOutcome::kHelp);
  EXPECT_EQ(Parse({"--version"}).outcome, ParseOutcome::kVersion);
}

}  // namespace
}  // namespace mapweld::executive
