// SPDX-License-Identifier: Apache-2.0
// Answers the host's requests from the spool, a chunk at a time, never faster than the byte budget. Keyframes and
// submaps of earlier boots are answered like those of this one. The host may not know how far an earlier drive came,
// because what was said last was lost or never sent: the last keyframe of one earlier boot after the other is said
// again now and then, and the host asks for what lies before it.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/ring_buffer.hpp"
#include "core/config/capacity.hpp"
#include "drivers/messages/codec.hpp"
#include "drivers/spool/record_spool.hpp"
#include "firmware-like/byte_budget.hpp"
#include "firmware-like/telemetry.hpp"

namespace mapweld::executive {

// What the spool keeps.
enum class RecordKind : std::uint8_t { kKeyframe = 0, kSubmap = 1 };

class AnswerQueue {
 public:
  AnswerQueue(std::int64_t bytes_per_s, spool::RecordSpool* spool, Telemetry* telemetry)
      : budget_(bytes_per_s, kBurstBytes),
        spool_(spool),
        telemetry_(telemetry),
        reminded_epoch_(telemetry->identity().epoch) {}

  // Takes what is not queued yet. When kCap.request_queue answers wait, the rest is dropped: the host asks again.
  void Add(const mapweldlcm::request_t& request);
  // Queues the last keyframe of the next earlier boot. Call every kRemindEvery.
  void RemindOfEarlierDrives();
  static constexpr DurationNs kRemindEvery = Milliseconds(10'000);
  // Sends as much as the budget allows at time now (monotonic). True while something is left.
  bool Step(TimeNs now);

  [[nodiscard]] std::int32_t submaps_sent() const { return submaps_sent_; }

 private:
  static constexpr std::int64_t kBurstBytes = 32 * 1400;
  using Answer = spool::RecordSpool::Key;

  void Queue(const Answer& answer);
  bool LoadNext();

  ByteBudget budget_;
  spool::RecordSpool* spool_;
  Telemetry* telemetry_;
  RingBuffer<Answer, kCap.request_queue> queue_;
  bool loaded_ = false;  // queue_.front() is in record_
  std::size_t bytes_ = 0;
  std::size_t offset_ = 0;
  std::int32_t submaps_sent_ = 0;
  std::int32_t reminded_epoch_;
  std::array<std::uint8_t, kCap.submap_encoded_bytes> record_{};
};

}  // namespace mapweld::executive
