// SPDX-License-Identifier: Apache-2.0
// What a store keeps, as bytes and back. Little endian, doubles as their bits: what is read is what was written.
// Decoders take any bytes: false for what no encoder wrote; *out is then undefined but valid. Linear in the bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tools/merge/drive.hpp"
#include "tools/merge/merge_result.hpp"
#include "tools/store/database.hpp"

namespace mapweld::store {

// One drive of an agent or of a recording.
struct DriveInfo {
  std::string name;               // unique in a store
  std::int16_t agent = 0;         // 0: a recording
  std::int32_t epoch = 0;         // boot count of the agent
  std::int32_t published = 0;     // keyframes that the agent says it has sent
  bool ended = false;             // no further keyframes will come
  bool disputed = false;          // two agents with one id took part: never merged
  std::uint64_t fingerprint = 0;  // of the recording that it was made from
  bool operator==(const DriveInfo&) const = default;
};

// The odometry of a recording, scan by scan; what merge::MergedScanPoses needs.
struct ScanTrajectory {
  std::vector<TimeNs> times;
  std::vector<geom::Pose3> odom_T_scan;
  std::vector<double> scan_path_m;
};

// What a merge found between two drives, without the difference image, which is quickly made again.
struct PairRecord {
  std::uint64_t method = 0;  // of the program and configuration that searched
  std::int32_t keyframes_a = 0;
  std::int32_t keyframes_b = 0;
  bool proposed = false;
  double evidence = 0;
  merge::Overlap overlap;                                // drive_a 0, drive_b 1
  std::vector<std::pair<merge::SubmapKey, bool>> asked;  // drive 0 or 1
};

// One state of the city in its history.
struct MergeRecord {
  std::string when;       // time label, UTC, for people
  std::string cause;      // "merge", "undo of 7", ...
  bool is_final = false;  // of a run that came to its end
  std::vector<std::string> drives;
  std::vector<std::int32_t> keyframes;                  // per drive
  std::vector<std::vector<std::int32_t>> groups;        // indices into drives
  std::vector<merge::Overlap> overlaps;                 // every decision with its evidence
  std::vector<std::vector<geom::Pose3>> merged_T_body;  // per drive and keyframe
};

// What somebody decided by hand.
struct Ruling {
  enum class Kind : std::uint8_t { kRefusePair = 0, kQuarantine = 1 };
  Kind kind = Kind::kRefusePair;
  std::string drive_a;
  std::string drive_b;  // empty for a quarantine
  std::string when;
};

Bytes Encode(const DriveInfo& drive);
Bytes Encode(const merge::Keyframe& keyframe);
Bytes Encode(const merge::SubmapCloud& cloud);               // exact: 12 bytes a point
Bytes EncodedByAgent(std::span<const std::uint8_t> submap);  // core/submap/submap_codec.hpp
Bytes Encode(const ScanTrajectory& trajectory);
Bytes Encode(const PairRecord& pair);
Bytes Encode(const MergeRecord& merge);
Bytes Encode(const Ruling& ruling);

bool Decode(std::span<const std::uint8_t> bytes, DriveInfo* out);
bool Decode(std::span<const std::uint8_t> bytes, merge::Keyframe* out);
bool Decode(std::span<const std::uint8_t> bytes, merge::SubmapCloud* out);
bool Decode(std::span<const std::uint8_t> bytes, ScanTrajectory* out);
bool Decode(std::span<const std::uint8_t> bytes, PairRecord* out);
bool Decode(std::span<const std::uint8_t> bytes, MergeRecord* out);
bool Decode(std::span<const std::uint8_t> bytes, Ruling* out);

}  // namespace mapweld::store
