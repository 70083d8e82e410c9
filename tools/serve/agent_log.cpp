// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/agent_log.hpp"

#include <fmt/format.h>

#include <span>
#include <stdexcept>
#include <utility>

#include "drivers/messages/channel.hpp"
#include "drivers/messages/codec.hpp"

namespace mapweld::serve {
namespace {

std::span<const std::uint8_t> BytesOf(const lcm::LogEvent& event) {
  return {static_cast<const std::uint8_t*>(event.data), static_cast<std::size_t>(event.datalen)};
}

}  // namespace

AgentLog::AgentLog(const std::filesystem::path& path) : path_(path), file_(path.string(), "r") {
  if (!file_.good()) throw std::runtime_error(fmt::format("cannot open the LCM log {}", path.string()));
  FleetStore store;
  for (;;) {
    const long offset = std::ftell(file_.getFilePtr());
    const lcm::LogEvent* event = file_.readNextEvent();
    if (event == nullptr) break;
    const auto channel = messages::ParseChannel(event->channel);
    if (!channel.ok()) continue;
    if (channel.value().kind == messages::Kind::kKeyframe) {
      mapweldlcm::keyframe_t message;
      messages::Decode(BytesOf(*event), &message) == Status::kOk ? store.Add(message) : void(++refused_);
    } else if (channel.value().kind == messages::Kind::kSubmapChunk) {
      mapweldlcm::submap_chunk_t message;
      if (messages::Decode(BytesOf(*event), &message) == Status::kOk) {
        pieces_[{{message.agent_id, message.epoch}, message.keyframe}].push_back(offset);
      } else {
        ++refused_;
      }
    }
  }
  FleetStore::Snapshot snapshot = store.Drives();
  ids_ = std::move(snapshot.ids);
  drives_ = std::move(snapshot.drives);
  if (drives_.empty()) {
    throw std::runtime_error(fmt::format("{} holds no keyframes; is it an LCM log of agents?", path.string()));
  }
  const std::string stem = path.stem().string();
  for (merge::Drive& drive : drives_) drive.name = drives_.size() == 1 ? stem : stem + "_" + drive.name;
}

std::optional<WholeSubmap> AgentLog::Whole(std::size_t drive, std::int32_t keyframe) {
  const auto pieces = pieces_.find({ids_.at(drive), keyframe});
  if (pieces == pieces_.end()) return std::nullopt;
  FleetStore assembly;
  for (const mapweldlcm::submap_chunk_t& message : Read(pieces->second)) {
    auto whole = assembly.Assemble(message);
    if (whole.has_value()) return whole;
  }
  return std::nullopt;
}

std::vector<mapweldlcm::submap_chunk_t> AgentLog::Read(const std::vector<long>& offsets) {
  const std::lock_guard lock(file_mutex_);
  std::vector<mapweldlcm::submap_chunk_t> read;
  for (const long offset : offsets) {
    if (std::fseek(file_.getFilePtr(), offset, SEEK_SET) != 0) break;
    const lcm::LogEvent* event = file_.readNextEvent();
    mapweldlcm::submap_chunk_t message;
    if (event == nullptr || messages::Decode(BytesOf(*event), &message) != Status::kOk) break;
    read.push_back(std::move(message));
  }
  return read;
}

std::shared_ptr<const merge::SubmapCloud> AgentLog::Submap(std::size_t drive, std::int32_t keyframe) {
  auto whole = Whole(drive, keyframe);
  return whole.has_value() ? std::make_shared<const merge::SubmapCloud>(std::move(whole->cloud)) : nullptr;
}

}  // namespace mapweld::serve
