// SPDX-License-Identifier: Apache-2.0
// The IMU, whichever it is and whichever way its frames come: an Xsens MTi or one that a .dbc file describes; a CAN
// interface, or a log that is read as far as the LiDAR has come.
#pragma once

#include <array>
#include <cstdint>

#include "core/pipeline/agent_pipeline.hpp"
#include "drivers/can/candump_port.hpp"
#include "drivers/can/dbc_imu_codec.hpp"
#include "drivers/can/socketcan_port.hpp"
#include "drivers/can/xsens_codec.hpp"
#include "firmware-like/options.hpp"

namespace mapweld::executive {

class ImuSource {
 public:
  explicit ImuSource(const Options& options);

  // Reads the description of the IMU, if one was given. kIo with errno when the file cannot be read, kFull when it is
  // longer than kMaxSetupFileBytes; otherwise as DbcImuCodec::Configure.
  Status LoadDescription(const Options& options);
  // kIo with errno when the interface or the log cannot be opened.
  Status Open(const Options& options);

  // Live: takes what the socket holds. Replayed: nothing.
  void Drain(pipeline::AgentPipeline* pipeline);
  // Live: goes on when the interface was unplugged and is there again. Call a few times per second.
  void Reconnect() {
    if (!replayed_) (void)socket_.Reconnect();
  }
  // Replayed: reads on until the newest sample is at or after t (sensor time), or the log ends. Live: nothing.
  void ReadUntil(TimeNs t, pipeline::AgentPipeline* pipeline);

  [[nodiscard]] int poll_fd() const { return replayed_ ? -1 : socket_.fd(); }
  [[nodiscard]] bool has_sample() const { return has_sample_; }
  [[nodiscard]] TimeNs newest() const { return newest_; }

  [[nodiscard]] std::uint64_t frames() const { return described_ ? dbc_.counters().frames : xsens_.counters().frames; }
  [[nodiscard]] std::uint64_t samples() const {
    return described_ ? dbc_.counters().samples : xsens_.counters().samples;
  }
  [[nodiscard]] std::uint64_t rejected() const { return described_ ? dbc_.counters().Rejected() : xsens_.Rejected(); }
  [[nodiscard]] std::uint64_t kernel_drops() const { return socket_.counters().kernel_drops; }

 private:
  void Push(const can::CanFrame& frame, pipeline::AgentPipeline* pipeline);

  bool replayed_;
  bool described_;  // by a .dbc file
  bool has_sample_ = false;
  TimeNs newest_;
  can::SocketCanPort socket_;
  can::CandumpPort log_;
  can::XsensCodec xsens_;
  can::DbcImuCodec dbc_;
  std::array<can::CanFrame, can::SocketCanPort::kBatch> frames_{};
};

}  // namespace mapweld::executive
