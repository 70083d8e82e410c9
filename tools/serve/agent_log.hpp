// SPDX-License-Identifier: Apache-2.0
// Drives from an LCM log of what agents published: `lcm-logger`'s recording of a fleet, or a simulated drive.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "tools/serve/fleet_store.hpp"

namespace mapweld::serve {

// Reads the log once for its keyframes and remembers where the pieces of each submap lie; a submap is read when it is
// asked for. Submaps may be asked for by several threads.
class AgentLog {
 public:
  // Throws std::runtime_error naming the file when it cannot be read or holds no keyframes. Messages of other programs
  // and broken ones are passed over.
  explicit AgentLog(const std::filesystem::path& path);

  // By agent and epoch. A drive that is alone in its log is called like the file, others get their DriveName behind it.
  [[nodiscard]] const std::vector<merge::Drive>& drives() const { return drives_; }
  // Nothing when the log does not hold all of it, or what it holds is broken.
  std::optional<WholeSubmap> Whole(std::size_t drive, std::int32_t keyframe);
  // Null when the log does not hold all of it, or what it holds is broken.
  std::shared_ptr<const merge::SubmapCloud> Submap(std::size_t drive, std::int32_t keyframe);
  // Messages of ours that were refused.
  [[nodiscard]] std::uint64_t refused() const { return refused_; }

 private:
  // The messages at these places of the file, up to the first that cannot be read.
  std::vector<mapweldlcm::submap_chunk_t> Read(const std::vector<long>& offsets);

  std::filesystem::path path_;
  std::mutex file_mutex_;
  lcm::LogFile file_;
  std::vector<DriveId> ids_;
  std::vector<merge::Drive> drives_;
  std::map<std::pair<DriveId, std::int32_t>, std::vector<long>> pieces_;  // offsets of the events in the file
  std::uint64_t refused_ = 0;
};

}  // namespace mapweld::serve
