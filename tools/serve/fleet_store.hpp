// SPDX-License-Identifier: Apache-2.0
// Everything the agents have sent: keyframes, health, submaps as they come in pieces. In memory.
#pragma once

#include <cstdint>
#include <map>
#include <mapweldlcm/health_t.hpp>
#include <mapweldlcm/keyframe_t.hpp>
#include <mapweldlcm/submap_chunk_t.hpp>
#include <optional>
#include <vector>

#include "tools/merge/drive.hpp"

namespace mapweld::serve {

// One drive: an agent between two starts. Its odometry has one frame.
struct DriveId {
  std::int16_t agent = 0;
  std::int32_t epoch = 0;
  auto operator<=>(const DriveId&) const = default;
};

// "agent_3", or "agent_3_boot_2" for later starts.
std::string DriveName(const DriveId& id);

struct FleetCounters {
  std::uint64_t keyframes = 0;
  std::uint64_t repeated_keyframes = 0;
  std::uint64_t submaps = 0;
  std::uint64_t repeated_chunks = 0;
  std::uint64_t broken_submaps = 0;  // complete, but refused by the decoder
};

// Takes messages in any order, any number of times. The same set of messages gives the same drives. Not thread safe.
class FleetStore {
 public:
  void Add(const mapweldlcm::keyframe_t& message);
  void Add(const mapweldlcm::health_t& message);
  void Add(const mapweldlcm::submap_chunk_t& message);

  // Drives with at least one keyframe, by agent and epoch. Each holds the keyframes 0..n-1 without a gap.
  struct Snapshot {
    std::vector<DriveId> ids;
    std::vector<merge::Drive> drives;
  };
  [[nodiscard]] Snapshot Drives() const;

  // Keyframes that the agent has published (by its health or by later ones) and that have not arrived. At most `most`.
  [[nodiscard]] std::vector<std::int32_t> MissingKeyframes(const DriveId& id, std::size_t most) const;
  // Null while not complete.
  [[nodiscard]] const merge::SubmapCloud* FindSubmap(const DriveId& id, std::int32_t keyframe) const;

  // The drive is over and every keyframe of it is here.
  [[nodiscard]] bool IsComplete(const DriveId& id) const;
  [[nodiscard]] std::vector<DriveId> Ids() const;
  [[nodiscard]] std::optional<mapweldlcm::health_t> Health(const DriveId& id) const;
  // Payload of the messages that arrived, repeated ones included.
  [[nodiscard]] std::uint64_t KeyframeBytes(const DriveId& id) const;
  [[nodiscard]] std::uint64_t SubmapBytes(const DriveId& id) const;
  [[nodiscard]] const FleetCounters& counters() const { return counters_; }

 private:
  struct PartialSubmap {
    std::vector<std::uint8_t> bytes;
    std::map<std::int32_t, std::int32_t> pieces;  // offset -> length
  };
  struct DriveData {
    std::map<std::int32_t, merge::Keyframe> keyframes;
    std::map<std::int32_t, PartialSubmap> partial;
    std::map<std::int32_t, merge::SubmapCloud> submaps;
    std::optional<mapweldlcm::health_t> health;
    std::uint64_t keyframe_messages = 0;
    std::uint64_t chunk_messages = 0;
  };

  std::map<DriveId, DriveData> drives_;
  FleetCounters counters_;
};

}  // namespace mapweld::serve
