// SPDX-License-Identifier: Apache-2.0
// Makes scans out of a folder of clouds.
#pragma once

#include <cstddef>

#include "core/sensor/scan.hpp"
#include "tools/io/recording_folder.hpp"

namespace mapweld::odometry {

// How the points of a cloud got their times.
enum class Sweep {
  kNone,              // all at once: clouds without motion distortion
  kClockwise,         // a spinning sensor seen from above; the sweep begins and ends behind the vehicle
  kCounterClockwise,  // the same, the other way round
};

// The i-th cloud as one revolution that ends at its time stamp. Points beyond the capacity of a scan are dropped.
void LoadScan(const io::RecordingFolder& folder, std::size_t i, Sweep sweep, sensor::Scan* scan);

}  // namespace mapweld::odometry
