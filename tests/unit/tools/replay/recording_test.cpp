// SPDX-License-Identifier: Apache-2.0
#include "tools/replay/recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/tools/sim/test_folder.hpp"
#include "tools/sim/candump.hpp"
#include "tools/sim/pcap_writer.hpp"

namespace mapweld::replay {
namespace {

class RecordingFolder : public testing::Test {
 protected:
  void Write(const std::vector<std::int64_t>& lidar_us, const std::vector<std::int64_t>& can_us) {
    sim::PcapWriter pcap(folder_ / "lidar.pcap", kLidarPorts[0]);
    for (const auto t : lidar_us) pcap.Write(t * 1000, std::vector<std::uint8_t>(1206, static_cast<std::uint8_t>(t)));
    pcap.Close();
    std::string log;
    for (const auto t : can_us) log += sim::CandumpLine(t * 1000, {0x005, 4, {}});
    sim::WriteText(folder_ / "imu.candump", log);
  }
  // Stamps in microseconds; those of CAN frames negative.
  std::vector<std::int64_t> Play(bool with_can) {
    Recording recording(folder_ / "", with_can);
    std::vector<std::int64_t> order;
    for (Event event; recording.Next(&event);) {
      order.push_back(event.lidar.empty() ? -event.stamp_ns / 1000 : event.stamp_ns / 1000);
      if (!event.lidar.empty()) {
        EXPECT_EQ(event.lidar[0], event.stamp_ns / 1000);
      }
    }
    return order;
  }
  const sim::TestFolder folder_;
};

TEST_F(RecordingFolder, MergesByStampWithTheImuFirst) {
  Write({10, 20, 30}, {5, 10, 15, 29, 31, 40});
  EXPECT_THAT(Play(true), testing::ElementsAre(-5, -10, 10, -15, 20, -29, 30, -31, -40));
}

TEST_F(RecordingFolder, PlaysTheLidarAloneWhenCanIsNotWanted) {
  Write({10, 20}, {5});
  std::filesystem::remove(folder_ / "imu.candump");
  EXPECT_THAT(Play(false), testing::ElementsAre(10, 20));
  EXPECT_THAT(sim::MessageOf([this] { (void)Play(true); }), testing::HasSubstr("imu.candump"));
}

TEST_F(RecordingFolder, PlaysOneSensorToItsEndAfterTheOther) {
  Write({1, 2, 3}, {});
  EXPECT_THAT(Play(true), testing::ElementsAre(1, 2, 3));
  Write({}, {1, 2});
  EXPECT_THAT(Play(true), testing::ElementsAre(-1, -2));
}

}  // namespace
}  // namespace mapweld::replay
