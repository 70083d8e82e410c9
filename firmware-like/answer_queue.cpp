// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/answer_queue.hpp"

#include <algorithm>

namespace mapweld::executive {

bool AnswerQueue::IsQueued(const Answer& answer) const {
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    if (queue_[i].kind == answer.kind && queue_[i].index == answer.index) return true;
  }
  return false;
}

void AnswerQueue::Add(const mapweldlcm::request_t& request) {
  const RecordKind kind =
      request.kind == mapweldlcm::request_t::KIND_SUBMAP ? RecordKind::kSubmap : RecordKind::kKeyframe;
  for (int i = 0; i < request.n; ++i) {
    const Answer answer{kind, request.index[i]};
    if (queue_.size() == queue_.capacity() || IsQueued(answer)) continue;
    if (spool_->Has(static_cast<std::uint8_t>(kind), answer.index)) queue_.Push(answer);
  }
}

bool AnswerQueue::LoadNext() {
  while (!queue_.empty() && !loaded_) {
    const Answer& answer = queue_.front();
    const auto bytes = spool_->Read(static_cast<std::uint8_t>(answer.kind), answer.index, record_);
    if (!bytes.ok()) {  // counted by the spool
      queue_.PopFront();
      continue;
    }
    loaded_ = true;
    bytes_ = bytes.value();
    offset_ = 0;
  }
  return loaded_;
}

bool AnswerQueue::Step(TimeNs now) {
  while (LoadNext()) {
    const Answer answer = queue_.front();
    const std::size_t next =
        answer.kind == RecordKind::kSubmap ? std::min(Telemetry::kChunkBytes, bytes_ - offset_) : bytes_;
    // A chunk is padded to its full size on the wire; the budget counts what leaves the machine.
    if (!budget_.TrySpend(static_cast<std::int64_t>(kCap.datagram_bytes), now)) return true;
    if (answer.kind == RecordKind::kSubmap) {
      (void)telemetry_->PublishSubmapChunk(answer.index, {record_.data(), bytes_}, offset_);
    } else {
      telemetry_->RepeatKeyframe({record_.data(), bytes_});
    }
    offset_ += next;
    if (offset_ < bytes_) continue;
    if (answer.kind == RecordKind::kSubmap) ++submaps_sent_;
    queue_.PopFront();
    loaded_ = false;
  }
  return false;
}

}  // namespace mapweld::executive
