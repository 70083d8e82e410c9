// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/imu_source.hpp"

#include "firmware-like/read_file.hpp"

namespace mapweld::executive {
namespace {

can::XsensOptions CodecOptions(const Options& options) {
  can::XsensOptions codec;
  codec.ids = options.imu_ids;
  codec.sample_time_unit = can::SampleTimeUnit::kDetect;
  codec.inertial_order = can::InertialOrder::kDetect;
  codec.clock_mode = options.time_source == TimeSource::kShared ? time::ClockMode::kShared : time::ClockMode::kReceive;
  return codec;
}

}  // namespace

ImuSource::ImuSource(const Options& options)
    : replayed_(options.candump_path != nullptr),
      described_(options.imu_dbc_path != nullptr),
      xsens_(CodecOptions(options)) {}

Status ImuSource::LoadDescription(const Options& options) {
  if (!described_) return Status::kOk;
  std::array<char, kMaxSetupFileBytes> text;
  std::size_t bytes = 0;
  if (const Status status = ReadFile(options.imu_dbc_path, text, &bytes); status != Status::kOk) return status;
  return dbc_.Configure({text.data(), bytes}, options.imu_signals);
}

Status ImuSource::Open(const Options& options) {
  if (replayed_) return log_.Open(options.candump_path);
  return socket_.Open(options.can_interface, described_ ? dbc_.wanted_ids() : std::span(options.imu_ids.all()));
}

void ImuSource::Push(const can::CanFrame& frame, pipeline::AgentPipeline* pipeline) {
  sensor::ImuSample sample;
  const Status status = described_ ? dbc_.Push(frame, &sample) : xsens_.Push(frame, &sample);
  if (status != Status::kOk) return;
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
