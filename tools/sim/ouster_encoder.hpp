// SPDX-License-Identifier: Apache-2.0
// The lidar packet of an Ouster OS1, profile RNG19_RFL8_SIG16_NIR16 (firmware 2.3 and later), as its software user
// manual describes it: 16 columns of all beams, between a header and a footer of 32 bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/sim/lidar_simulator.hpp"

namespace mapweld::sim {

inline constexpr std::uint16_t kOusterPort = 7502;
inline constexpr std::int64_t kOusterColumns = 16;  // per packet

bool IsOuster(const LidarModel& model);

// Packet `index` holds the columns from index * kOusterColumns on. Columns count from where the sensor's connector is,
// backward; their stamps are the sensor's time, nanoseconds. Signal is the reflectivity again, near infrared nothing.
// *returns grows by the number of beams that came back.
std::vector<std::uint8_t> EncodeOuster(const LidarSimulator& lidar, std::int64_t index, std::int64_t* returns);

// The sensor's metadata (JSON), without which nobody can read its packets. The simulated beams start in the axis of
// rotation, those of the real one 15.8 mm beside it.
std::string OusterMetadataJson(const LidarModel& model);

}  // namespace mapweld::sim
