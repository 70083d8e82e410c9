// SPDX-License-Identifier: Apache-2.0
// The host's end of the LCM network: a thread that puts what agents send into the FleetStore, and the messages back.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/geom/pose3.hpp"
#include "tools/serve/fleet_journal.hpp"
#include "tools/serve/fleet_store.hpp"
#include "tools/serve/presence.hpp"

namespace lcm {
class LCM;
struct ReceiveBuffer;
}  // namespace lcm

namespace mapweld::serve {

// Where one keyframe is in the merged map.
struct MergedKeyframe {
  std::int32_t keyframe = 0;
  std::int32_t group = 0;
  geom::Pose3 merged_T_body;
  double sigma_m = 0.2;
  double sigma_rad = 0.01;
};

class FleetLink {
 public:
  // Joins the network and starts to listen. Throws one sentence when the network cannot be joined. city: keeps what
  // comes and gives what came before; null: nothing lasts.
  explicit FleetLink(const std::string& lcm_url, store::CityStore* city = nullptr);
  ~FleetLink();
  FleetLink(const FleetLink&) = delete;
  FleetLink& operator=(const FleetLink&) = delete;

  // Runs f with the store, while nothing else touches it. Keep it short: messages wait.
  template <class F>
  auto WithStore(F f) {
    const std::lock_guard lock(mutex_);
    return f(store_);
  }

  // Sleeps until something new has come, or for `most`.
  void WaitForNews(std::chrono::milliseconds most);
  [[nodiscard]] bool IsHere(const DriveId& id);
  // What the user has to know, one sentence each; empty when all is well.
  [[nodiscard]] std::vector<std::string> Warnings();
  // Records that are in memory only, because the disk fails.
  [[nodiscard]] std::size_t unsaved();

  // Asks for keyframes or submaps, at most 64 per message.
  void RequestKeyframes(const DriveId& id, const std::vector<std::int32_t>& keyframes);
  void RequestSubmaps(const DriveId& id, const std::vector<std::int32_t>& keyframes);
  void SendMergedPoses(const DriveId& id, std::int32_t revision, const std::vector<MergedKeyframe>& poses);

  [[nodiscard]] std::uint64_t refused() const { return refused_; }

 private:
  void Listen();
  void OnMessage(const lcm::ReceiveBuffer* received, const std::string& channel);
  void Request(const DriveId& id, std::int8_t kind, const std::vector<std::int32_t>& keyframes);

  std::unique_ptr<lcm::LCM> lcm_;
  std::mutex mutex_;
  std::condition_variable news_;
  bool has_news_ = false;
  FleetStore store_;
  FleetJournal journal_;
  Presence presence_;
  std::atomic<std::uint64_t> refused_{0};  // messages that the decoder did not accept
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace mapweld::serve
