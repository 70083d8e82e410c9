// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/simulate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/unit/tools/sim/test_folder.hpp"
#include "tools/sim/scenario.hpp"

namespace mapweld::sim {
namespace {

using testing::HasSubstr;

class Simulation : public testing::Test {
 protected:
  SimOptions Options(const std::string& name, unsigned threads) {
    SimOptions options;
    options.scenario = ScenarioByName("four_drives");
    options.out = folder_ / name;
    options.seconds = 1.5;
    options.threads = threads;
    return options;
  }
  static SimSummary Run(const SimOptions& options) {
    return Simulate(options, [](int, double) {});
  }
  void ExpectSameDrive(const std::string& a, const std::string& b, int vehicle) {
    const std::string folder = "vehicle_" + std::to_string(vehicle);
    for (const char* file : {"lidar.pcap", "imu.candump", "truth.tum"}) {
      EXPECT_TRUE(ReadText(folder_ / a / folder / file) == ReadText(folder_ / b / folder / file))
          << file << " of vehicle " << vehicle << " differs";
    }
  }
  const TestFolder folder_;
};

TEST_F(Simulation, GivesTheSameBytesWithAnyNumberOfThreadsAndInAnyCompany) {
  (void)Run(Options("one", 1));
  (void)Run(Options("two", 2));
  SimOptions alone = Options("alone", 1);
  alone.vehicles = {3};
  (void)Run(alone);
  for (int vehicle = 1; vehicle <= 4; ++vehicle) ExpectSameDrive("one", "two", vehicle);
  EXPECT_EQ(ReadText(folder_ / "one/scenario.json"), ReadText(folder_ / "two/scenario.json"));
  ExpectSameDrive("one", "alone", 3);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "alone/vehicle_1"));
}

TEST_F(Simulation, GivesTheSameBytesOfAWholeScenarioTwice) {
  for (const Layout layout : {Layout::kSubmaps, Layout::kWire, Layout::kKitti}) {
    SimOptions options = Options("first", 2);
    options.scenario = ScenarioByName("plaza");
    options.seconds = layout == Layout::kSubmaps ? 15 : 4;
    options.layout = layout;
    (void)Run(options);
    options.out = folder_ / "second";
    options.threads = 1;
    (void)Run(options);
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / "first")) {
      if (!entry.is_regular_file()) continue;
      const auto name = std::filesystem::relative(entry.path(), folder_ / "first");
      EXPECT_TRUE(ReadText(entry.path()) == ReadText(folder_ / "second" / name)) << name;
      ++files;
    }
    EXPECT_GT(files, 8) << "a file for each drive and the list of overlaps";
  }
}

TEST_F(Simulation, ChangesTheNoiseWithTheSeedButNotTheStreets) {
  SimOptions options = Options("a", 0);
  options.vehicles = {1};
  (void)Run(options);
  options.out = folder_ / "b";
  options.seed = 99;
  (void)Run(options);
  EXPECT_NE(ReadText(folder_ / "a/vehicle_1/lidar.pcap"), ReadText(folder_ / "b/vehicle_1/lidar.pcap"));
  const auto start_of = [&](const char* name) {
    std::istringstream truth(ReadText(folder_ / name / "vehicle_1/truth.tum"));
    double t = 0;
    Eigen::Vector2d p;
    truth >> t >> p.x() >> p.y();
    return p;
  };
  EXPECT_LT((start_of("a") - start_of("b")).norm(), 1.0) << "the same street, elsewhere in the lane";
}

TEST_F(Simulation, WritesCompleteRecordings) {
  const SimSummary summary = Run(Options("r", 0));
  ASSERT_EQ(summary.vehicles.size(), 4U);
  const DriveCounts& counts = summary.vehicles[1].counts;
  EXPECT_EQ(counts.packets, 1130);  // 1.5 s / 1.327104 ms
  EXPECT_EQ(counts.imu_samples, 300);
  EXPECT_EQ(std::filesystem::file_size(folder_ / "r/vehicle_2/lidar.pcap"), 24U + 1130U * (16U + 42U + 1206U));
  std::istringstream log(ReadText(folder_ / "r/vehicle_2/imu.candump"));
  std::string line;
  ASSERT_TRUE(std::getline(log, line));
  EXPECT_EQ(line, "(0000000602.000400) can0 005#005BDBA0");  // 6020000 units of 100 us
  std::istringstream truth(ReadText(folder_ / "r/vehicle_2/truth.tum"));
  double t = 0;
  double x = 0;
  double y = 0;
  double z = 0;
  truth >> t >> x >> y >> z;
  EXPECT_EQ(t, 602.0);
  EXPECT_LT(std::abs(z - 1.5), 10) << "on a hill of the scenario's relief";
  const auto description = nlohmann::json::parse(ReadText(folder_ / "r/scenario.json"));
  EXPECT_EQ(description.at("vehicles").at(1).at("folder"), "vehicle_2");
  EXPECT_EQ(description.at("vehicles").at(1).at("start_s"), 602.0);
  EXPECT_EQ(description.at("body_T_lidar").at("t_m"), nlohmann::json({0.10, 0.0, 0.35}));
}

TEST_F(Simulation, WritesCloudsInTheLayoutsOfDataSets) {
  SimOptions options = Options("clouds", 0);
  options.vehicles = {2};
  options.seconds = 6;  // three of them standing
  options.lidar = "os1-64";
  options.layout = Layout::kKitti;
  const std::int64_t clouds = Run(options).vehicles.at(0).clouds;
  ASSERT_GT(clouds, 3);
  EXPECT_GT(std::filesystem::file_size(folder_ / "clouds/vehicle_2/velodyne/000000.bin"), 16U * 20'000);
  EXPECT_EQ(ReadText(folder_ / "clouds/vehicle_2/poses.txt").substr(0, 12), "1 0 0 0 0 1 ");
  options.layout = Layout::kMulran;
  (void)Run(options);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "clouds/vehicle_2/Ouster/602000000000.bin"));
  options.layout = Layout::kGprs;
  (void)Run(options);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "clouds/vehicle_2/000001.pcd"));
  EXPECT_EQ(std::filesystem::file_size(folder_ / "clouds/vehicle_2/000001_pose6d.npy"), 128U + 48U);
}

TEST_F(Simulation, WritesThePacketsOfAnOs1WithItsMetadata) {
  SimOptions options = Options("os1", 0);
  options.vehicles = {2};
  options.seconds = 1;
  options.lidar = "os1-64";
  EXPECT_EQ(Run(options).vehicles.at(0).counts.packets, 640) << "16 of 1024 columns each, ten turns";
  const auto metadata = nlohmann::json::parse(ReadText(folder_ / "os1/vehicle_2/lidar_metadata.json"));
  EXPECT_EQ(metadata.at("beam_intrinsics").at("beam_altitude_angles").size(), 64U);
  EXPECT_EQ(metadata.at("config_params").at("lidar_mode"), "1024x10");
}

TEST_F(Simulation, RefusesASensorThatItCannotBeBeforeAnyWork) {
  SimOptions options = Options("r", 0);
  options.lidar = "vlp17";
  EXPECT_THAT(MessageOf([&] { (void)Run(options); }), HasSubstr("known are vlp16, hdl32e"));
  options.lidar = "hdl64e";
  EXPECT_THAT(MessageOf([&] { (void)Run(options); }), HasSubstr("choose --layout kitti"));
  options.lidar = "os1-64";
  options.dual_return = true;
  EXPECT_THAT(MessageOf([&] { (void)Run(options); }), HasSubstr("dual return os1-64 packets are not written"));
  options.lidar = "vlp16";
  options.layout = Layout::kKitti;
  EXPECT_THAT(MessageOf([&] { (void)Run(options); }), HasSubstr("choose --layout wire"));
  options.vibration_mps2 = -1;
  EXPECT_THAT(MessageOf([&] { (void)Run(options); }), HasSubstr("not between 0 and 20"));
}

TEST_F(Simulation, ReplacesARecordingButNothingElse) {
  SimOptions options = Options("r", 0);
  options.vehicles = {1};
  (void)Run(options);
  options.vehicles = {2};
  (void)Run(options);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "r/vehicle_1"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "r/vehicle_2/lidar.pcap"));
  std::filesystem::create_directories(folder_ / "mine");
  WriteText(folder_ / "mine/diary.txt", "dear diary");
  options.out = folder_ / "mine";
  EXPECT_THAT(MessageOf([&] { (void)Run(options); }), HasSubstr("is not a recording"));
  EXPECT_EQ(ReadText(folder_ / "mine/diary.txt"), "dear diary");
}

TEST_F(Simulation, LeavesNothingBehindWhenItFails) {
  SimOptions options = Options("r", 0);
  options.vehicles = {9};
  EXPECT_THAT(MessageOf([&] { (void)Run(options); }), HasSubstr("no vehicle 9"));
  WriteText(folder_ / "s.json",
            R"({"name":"n","town":"gone.osm","origin":[50,11],"vehicles":[{"id":1,"route":[[50,11],[50.1,11]]}]})");
  options = Options("r", 0);
  options.scenario = folder_ / "s.json";
  EXPECT_THAT(MessageOf([&] { (void)Run(options); }), HasSubstr("gone.osm does not exist"));
  std::size_t left = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "")) left += entry.exists() ? 1U : 0U;
  EXPECT_EQ(left, 1U) << "only the scenario file";
}

}  // namespace
}  // namespace mapweld::sim
