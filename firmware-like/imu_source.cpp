// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/imu_source.hpp"

namespace mapweld::executive {
namespace {

can::XsensOptions CodecOptions(const Options& options) {
  can::XsensOptions codec;
  codec.clock_mode = options.time_source == TimeSource::kShared ? time::ClockMode::kShared : time::ClockMode::kReceive;
  return codec;
}

// SampleTime, GroupCounter, StatusWord, RateOfTurn, Acceleration: the rest of the bus is not ours.
constexpr std::uint16_t kWantedIds[] = {0x005, 0x006, 0x011, 0x032, 0x034};

}  // namespace

ImuSource::ImuSource(const Options& options)
    : replayed_(options.candump_path != nullptr), codec_(CodecOptions(options)) {}

Status ImuSource::Open(const Options& options) {
  return replayed_ ? log_.Open(options.candump_path) : socket_.Open(options.can_interface, kWantedIds);
}

void ImuSource::Push(const can::CanFrame& frame, pipeline::AgentPipeline* pipeline) {
  sensor::ImuSample sample;
  if (codec_.Push(frame, &sample) != Status::kOk) return;
  has_sample_ = true;
  newest_ = sample.t;
  pipeline->OnImu(sample);
}

void ImuSource::Drain(pipeline::AgentPipeline* pipeline) {
  std::size_t n = 0;
  while (!replayed_ && socket_.Receive(frames_, &n) == Status::kOk && n > 0) {
    for (std::size_t i = 0; i < n; ++i) Push(frames_[i], pipeline);
    if (n < frames_.size()) return;
  }
}

void ImuSource::ReadUntil(TimeNs t, pipeline::AgentPipeline* pipeline) {
  std::size_t n = 0;
  while (replayed_ && (!has_sample_ || newest_ < t)) {
    if (log_.Receive({frames_.data(), 1}, &n) != Status::kOk || n == 0) return;
    Push(frames_[0], pipeline);
  }
}

}  // namespace mapweld::executive
