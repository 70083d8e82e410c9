// SPDX-License-Identifier: Apache-2.0
// Where the agent's static memory goes, pinned: growth must be a decision.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "firmware-like/memory_map.hpp"

namespace mapweld {
namespace {

std::map<std::string, std::size_t> Parts() {
  return {
      {"agent (all)", sizeof(executive::AgentMemory)},
      {"pipeline", sizeof(pipeline::AgentPipeline)},
      {"pipeline/lio", sizeof(lio::Lio)},
      {"pipeline/lio/voxel_map", sizeof(lio::VoxelMap)},
      {"pipeline/scan_accumulator", sizeof(scan::ScanAccumulator)},
      {"pipeline/rolling_map", sizeof(submap::RollingMap)},
      {"pipeline/submap", sizeof(submap::Submap)},
      {"pipeline/describer", sizeof(place::Describer)},
      {"pipeline/correction", sizeof(correct::LocalCorrection)},
      {"imu_source", sizeof(executive::ImuSource)},
      {"lidar_port", sizeof(lidar::UdpPort)},
      {"bus", sizeof(bus::UdpmBus)},
      {"spool", sizeof(spool::RecordSpool)},
      {"answers", sizeof(executive::AnswerQueue)},
  };
}

std::map<std::string, std::size_t> Pinned() {
  std::ifstream file(MAPWELD_SOURCE_DIR "/tests/memory/budget.txt");
  std::map<std::string, std::size_t> pinned;
  std::string line;
  while (std::getline(file, line)) {
    const auto tab = line.find('\t');
    if (line.empty() || line[0] == '#' || tab == std::string::npos) continue;
    pinned[line.substr(0, tab)] = std::stoul(line.substr(tab + 1));
  }
  return pinned;
}

TEST(MemoryBudget, NoPartGrewByMoreThanThreePercentOverItsPin) {
  const auto pinned = Pinned();
  for (const auto& [part, bytes] : Parts()) {
    std::printf("%s\t%zu\n", part.c_str(), bytes);
    EXPECT_TRUE(pinned.contains(part)) << part << " has no pin in tests/memory/budget.txt";
    if (!pinned.contains(part)) continue;
    EXPECT_LE(static_cast<double>(bytes), 1.03 * static_cast<double>(pinned.at(part))) << part;
    EXPECT_GE(static_cast<double>(bytes), 0.90 * static_cast<double>(pinned.at(part)))
        << part << " shrank: lower its pin so that it cannot grow back unseen";
  }
  EXPECT_EQ(pinned.size(), Parts().size()) << "a pinned part no longer exists";
}

TEST(MemoryBudget, TheWholeAgentFitsItsBudget) {
  EXPECT_LE(sizeof(executive::AgentMemory), kRamBudgetBytes);
}

}  // namespace
}  // namespace mapweld
