// SPDX-License-Identifier: Apache-2.0
// Everything that is known of the fleet while `mapweld serve` runs: keyframes, health, submaps. In memory; what makes
// it last is fleet_journal.hpp.
#pragma once

#include <cstdint>
#include <map>
#include <mapweldlcm/health_t.hpp>
#include <mapweldlcm/keyframe_t.hpp>
#include <mapweldlcm/submap_chunk_t.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/merge/drive.hpp"
#include "tools/serve/drive_id.hpp"
#include "tools/serve/submap_assembly.hpp"

namespace mapweld::serve {

struct FleetCounters {
  std::uint64_t keyframes = 0;
  std::uint64_t repeated_keyframes = 0;
  std::uint64_t disputed_keyframes = 0;  // refused: another vehicle with the same id sends them
  std::uint64_t submaps = 0;
  std::uint64_t repeated_chunks = 0;
  std::uint64_t broken_submaps = 0;  // complete, but refused by the decoder
};

inline constexpr int kModeEnded = 4;  // health_t::mode: the drive is over

// A submap of which every piece has come.
struct WholeSubmap {
  DriveId id;
  std::int32_t keyframe = 0;
  std::vector<std::uint8_t> encoded;
  merge::SubmapCloud cloud;
};

merge::Keyframe FromMessage(const mapweldlcm::keyframe_t& message);

// Takes messages in any order, any number of times. The same set of messages gives the same drives. Not thread safe.
//
// Two vehicles with one id and one boot count are found when a keyframe comes a second time with another content. From
// then on nothing more is taken for that drive, and it is left out of the merge, because nobody can say whose keyframes
// it holds; unless it was complete before, when the newcomer alone is refused.
class FleetStore {
 public:
  void Add(const mapweldlcm::keyframe_t& message);
  void Add(const mapweldlcm::health_t& message);
  void Add(const mapweldlcm::submap_chunk_t& message);
  // The two halves of the last one, for whoever has to do something in between: the submap when this piece completes
  // it, and the submap becoming known.
  std::optional<WholeSubmap> Assemble(const mapweldlcm::submap_chunk_t& message);
  void AddSubmap(WholeSubmap submap);
  // By which name the drive goes, if not by its id.
  void Rename(const DriveId& id, const std::string& name) { drives_[id].name = name; }

  // What an earlier process knew.
  struct Restored {
    std::string name;
    std::map<std::int32_t, merge::Keyframe> keyframes;
    std::map<std::int32_t, merge::SubmapCloud> submaps;
    std::int32_t published = 0;
    bool ended = false;
    bool disputed = false;
  };
  void Restore(const DriveId& id, Restored restored);

  // Drives with at least one keyframe, by agent and epoch. Each holds the keyframes 0..n-1 without a gap.
  struct Snapshot {
    std::vector<DriveId> ids;
    std::vector<merge::Drive> drives;
  };
  [[nodiscard]] Snapshot Drives() const;

  // Keyframes that the agent has published (by its health or by later ones) and that have not arrived. At most `most`.
  [[nodiscard]] std::vector<std::int32_t> MissingKeyframes(const DriveId& id, std::size_t most) const;
  // Can this keyframe not be of the vehicle whose drive it claims to be of?
  [[nodiscard]] bool Contradicts(const mapweldlcm::keyframe_t& message) const;
  [[nodiscard]] bool HasKeyframe(const DriveId& id, std::int32_t index) const;
  // Null while not complete.
  [[nodiscard]] const merge::SubmapCloud* FindSubmap(const DriveId& id, std::int32_t keyframe) const;

  // The drive is over and every keyframe of it is here.
  [[nodiscard]] bool IsComplete(const DriveId& id) const;
  [[nodiscard]] bool IsDisputed(const DriveId& id) const;
  [[nodiscard]] bool HasEnded(const DriveId& id) const;
  // Keyframes that the agent says it has sent.
  [[nodiscard]] std::int32_t Published(const DriveId& id) const;
  [[nodiscard]] std::string NameOf(const DriveId& id) const;
  [[nodiscard]] std::vector<DriveId> Ids() const;
  // Of this process's time; nothing for a drive that was restored and has not been heard since.
  [[nodiscard]] std::optional<mapweldlcm::health_t> Health(const DriveId& id) const;
  // Payload of the messages that arrived, repeated ones included.
  [[nodiscard]] std::uint64_t KeyframeBytes(const DriveId& id) const;
  [[nodiscard]] std::uint64_t SubmapBytes(const DriveId& id) const;
  [[nodiscard]] const FleetCounters& counters() const { return counters_; }

 private:
  struct DriveData {
    std::string name;  // empty: by the id
    std::map<std::int32_t, merge::Keyframe> keyframes;
    std::int32_t contiguous = 0;  // keyframes 0..contiguous-1 are here
    std::map<std::int32_t, merge::SubmapCloud> submaps;
    std::optional<mapweldlcm::health_t> health;
    std::int32_t published = 0;
    bool ended = false;
    bool disputed = false;
    bool left_out = false;  // of the merge
    std::uint64_t keyframe_messages = 0;
    std::uint64_t chunk_messages = 0;
  };
  [[nodiscard]] const DriveData* Find(const DriveId& id) const;
  void Advance(DriveData* drive) const;

  std::map<DriveId, DriveData> drives_;
  SubmapAssembly assembly_;
  FleetCounters counters_;
};

}  // namespace mapweld::serve
