// SPDX-License-Identifier: Apache-2.0
// Every compile-time capacity of the agent, in one place, with the relations between them.
#pragma once

#include <cstddef>

namespace mapweld {

struct Capacity {
  // sensor
  std::size_t packet_points = 4096;  // one LiDAR packet: 16 columns of 128 beams with two returns
  std::size_t scan_points = 131072;  // one revolution before down-sampling
  std::size_t scan_features = 8192;  // one revolution after down-sampling
  std::size_t imu_ring = 1024;       // 2.5 s at 400 Hz
  // maps
  std::size_t lio_voxels = 65536;             // local map of the odometry
  std::size_t submap_map_voxels = 262144;     // rolling dense map behind the submaps
  std::size_t submap_points = 49152;          // one extracted submap
  std::size_t submap_encoded_bytes = 262144;  // one encoded submap
  std::size_t pending_keyframes = 64;         // keyframes not yet released
  // bus
  std::size_t datagram_bytes = 1400;  // one LCM message of the agent, so that it never fragments
  std::size_t request_queue = 256;    // submaps and keyframes asked for and not yet sent
  std::size_t spool_records = 16384;  // keyframes and submaps of one drive kept for later requests
  // correction
  std::size_t correction_window = 16;  // keyframes in the local optimisation
};
inline constexpr Capacity kCap{};

// The whole agent, all long-lived state.
inline constexpr std::size_t kRamBudgetBytes = 64U << 20U;

static_assert((kCap.lio_voxels & (kCap.lio_voxels - 1)) == 0, "hash tables are powers of two");
static_assert((kCap.submap_map_voxels & (kCap.submap_map_voxels - 1)) == 0, "hash tables are powers of two");
static_assert(kCap.scan_features <= kCap.scan_points);
static_assert(kCap.submap_points < kCap.submap_map_voxels);
static_assert(kCap.imu_ring >= 400 * 2, "the IMU ring bridges a LiDAR gap of 2 s at 400 Hz");
static_assert(kCap.submap_encoded_bytes >= 5 * kCap.submap_points, "a full submap of scattered points");

}  // namespace mapweld
