// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/fleet_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <lcm/lcm-cpp.hpp>
#include <span>
#include <stdexcept>
#include <type_traits>

#include "drivers/messages/channel.hpp"
#include "drivers/messages/codec.hpp"

namespace mapweld::serve {
namespace {

std::string ChannelName(int agent, messages::Kind kind) {
  messages::ChannelBuffer buffer;
  const auto name = messages::FormatChannel(&buffer, agent, kind);
  if (!name.ok()) throw std::runtime_error(fmt::format("agent id {} is outside 1..32767", agent));
  return std::string(name.value());
}

template <class Message>
void Publish(lcm::LCM* lcm, int agent, messages::Kind kind, const Message& message) {
  std::array<std::uint8_t, 2048> buffer;
  const auto bytes = messages::Encode(message, buffer);
  if (!bytes.ok()) return;  // a field is out of range: never send what the agent must refuse
  lcm->publish(ChannelName(agent, kind), buffer.data(), static_cast<unsigned>(bytes.value()));
}

// The burst of a fleet's answers; liblcm keeps the oldest messages and drops the newest when its queue is full.
constexpr int kQueuedMessages = 20000;
constexpr int kMessagesPerCommit = 500;  // at most; the disk is waited for once

}  // namespace

FleetLink::FleetLink(const std::string& lcm_url, store::CityStore* city)
    : lcm_(std::make_unique<lcm::LCM>(lcm_url)), journal_(city, &store_) {
  if (!lcm_->good()) {
    throw std::runtime_error(
        fmt::format("cannot join the LCM network {}; a machine without a route for multicast needs "
                    "'ip route add 224.0.0.0/4 dev lo'",
                    lcm_url));
  }
  lcm_->subscribe("MW\\..*\\.(KEYFRAME|HEALTH|SUBMAP_CHUNK)", &FleetLink::OnMessage, this)
      ->setQueueCapacity(kQueuedMessages);
  thread_ = std::thread([this] { Listen(); });
}

FleetLink::~FleetLink() {
  stop_ = true;
  thread_.join();
}

void FleetLink::OnMessage(const lcm::ReceiveBuffer* received, const std::string& channel) {
  const auto parsed = messages::ParseChannel(channel);
  if (!parsed.ok()) return;
  const std::span bytes(static_cast<const std::uint8_t*>(received->data), received->data_size);
  const auto take = [&](auto message) {
    if (messages::Decode(bytes, &message) != Status::kOk || message.agent_id != parsed.value().agent_id) {
      ++refused_;
      return;
    }
    // Keyframes and submaps may be of an earlier boot, from the agent's spool; health is always of the present one.
    if constexpr (std::is_same_v<decltype(message), mapweldlcm::health_t>) {
      const std::lock_guard lock(mutex_);
      presence_.Heard({message.agent_id, message.epoch}, Presence::Clock::now());
    }
    journal_.Take(message);
  };
  if (parsed.value().kind == messages::Kind::kKeyframe) take(mapweldlcm::keyframe_t{});
  if (parsed.value().kind == messages::Kind::kHealth) take(mapweldlcm::health_t{});
  if (parsed.value().kind == messages::Kind::kSubmapChunk) take(mapweldlcm::submap_chunk_t{});
}

void FleetLink::Listen() {
  while (!stop_) {
    bool some = lcm_->handleTimeout(200) > 0;
    for (int i = 1; some && i < kMessagesPerCommit; ++i) some = lcm_->handleTimeout(0) > 0;
    if (!journal_.Commit(FleetJournal::Clock::now(), &mutex_)) continue;
    const std::lock_guard lock(mutex_);
    has_news_ = true;
    news_.notify_all();
  }
}

void FleetLink::WaitForNews(std::chrono::milliseconds most) {
  std::unique_lock lock(mutex_);
  news_.wait_for(lock, most, [&] { return has_news_; });
  has_news_ = false;
}

bool FleetLink::IsHere(const DriveId& id) {
  const std::lock_guard lock(mutex_);
  return presence_.IsHere(id, Presence::Clock::now());
}

std::size_t FleetLink::unsaved() {
  const std::lock_guard lock(mutex_);
  return journal_.unsaved();
}

std::vector<std::string> FleetLink::Warnings() {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> warnings;
  for (const DriveId& id : store_.Ids()) {
    if (!store_.IsDisputed(id)) continue;
    warnings.push_back(fmt::format(
        "two vehicles call themselves agent {} in boot {}, and nothing more is taken from either; give each "
        "its own --agent-id, or its --state-dir back if that was lost",
        id.agent, id.epoch));
  }
  for (const std::int16_t agent : presence_.twins()) {
    warnings.push_back(
        fmt::format("agent {} speaks with two boot counts at a time: two vehicles with one id? Give each its own "
                    "--agent-id",
                    agent));
  }
  if (journal_.unsaved() > 0) {
    warnings.push_back(fmt::format("{} records are in memory only: {}", journal_.unsaved(), journal_.trouble()));
  }
  return warnings;
}

void FleetLink::Request(const DriveId& id, std::int8_t kind, const std::vector<std::int32_t>& keyframes) {
  mapweldlcm::request_t message{};
  message.agent_id = id.agent;
  message.epoch = id.epoch;
  message.kind = kind;
  constexpr std::size_t kMost = std::size(decltype(message.index){});
  for (std::size_t at = 0; at < keyframes.size(); at += kMost) {
    message.n = static_cast<std::int16_t>(std::min(kMost, keyframes.size() - at));
    std::copy_n(keyframes.begin() + static_cast<std::ptrdiff_t>(at), message.n, message.index);
    Publish(lcm_.get(), id.agent, messages::Kind::kRequest, message);
  }
}

void FleetLink::RequestKeyframes(const DriveId& id, const std::vector<std::int32_t>& keyframes) {
  Request(id, mapweldlcm::request_t::KIND_KEYFRAME, keyframes);
}

void FleetLink::RequestSubmaps(const DriveId& id, const std::vector<std::int32_t>& keyframes) {
  Request(id, mapweldlcm::request_t::KIND_SUBMAP, keyframes);
}

void FleetLink::SendMergedPoses(const DriveId& id, std::int32_t revision, const std::vector<MergedKeyframe>& poses) {
  for (const MergedKeyframe& pose : poses) {
    mapweldlcm::global_pose_t message{};
    message.agent_id = id.agent;
    message.epoch = id.epoch;
    message.keyframe = pose.keyframe;
    message.group = pose.group;
    message.revision = revision;
    for (int i = 0; i < 3; ++i) message.merged_t_body[i] = pose.merged_T_body.t(i);
    for (int i = 0; i < 4; ++i) message.merged_q_body[i] = pose.merged_T_body.q.coeffs()(i);
    message.sigma_m = static_cast<float>(pose.sigma_m);
    message.sigma_rad = static_cast<float>(pose.sigma_rad);
    Publish(lcm_.get(), id.agent, messages::Kind::kGlobalPose, message);
  }
}

}  // namespace mapweld::serve
