// SPDX-License-Identifier: Apache-2.0
// Answers the host's requests from the spool, a chunk at a time, never faster than the byte budget.
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
      : budget_(bytes_per_s, kBurstBytes), spool_(spool), telemetry_(telemetry) {}

  // Takes what is not queued yet. When kCap.request_queue answers wait, the rest is dropped: the host asks again.
  void Add(const mapweldlcm::request_t& request);
  // Sends as much as the budget allows at time now (monotonic). True while something is left.
  bool Step(TimeNs now);

  [[nodiscard]] std::int32_t submaps_sent() const { return submaps_sent_; }

 private:
  static constexpr std::int64_t kBurstBytes = 32 * 1400;
  struct Answer {
    RecordKind kind = RecordKind::kKeyframe;
    std::int32_t index = 0;
  };

  [[nodiscard]] bool IsQueued(const Answer& answer) const;
  bool LoadNext();

  ByteBudget budget_;
  spool::RecordSpool* spool_;
  Telemetry* telemetry_;
  RingBuffer<Answer, kCap.request_queue> queue_;
  bool loaded_ = false;  // queue_.front() is in record_
  std::size_t bytes_ = 0;
  std::size_t offset_ = 0;
  std::int32_t submaps_sent_ = 0;
  std::array<std::uint8_t, kCap.submap_encoded_bytes> record_{};
};

}  // namespace mapweld::executive
