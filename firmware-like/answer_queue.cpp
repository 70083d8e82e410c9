// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/answer_queue.hpp"

#include <algorithm>

namespace mapweld::executive {

void AnswerQueue::Queue(const Answer& answer) {
  if (queue_.size() == queue_.capacity()) return;
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    if (queue_[i] == answer) return;
  }
  if (spool_->Has(answer)) queue_.Push(answer);
}

void AnswerQueue::Add(const mapweldlcm::request_t& request) {
  const RecordKind kind =
      request.kind == mapweldlcm::request_t::KIND_SUBMAP ? RecordKind::kSubmap : RecordKind::kKeyframe;
  for (int i = 0; i < request.n; ++i) Queue({request.epoch, static_cast<std::uint8_t>(kind), request.index[i]});
}

void AnswerQueue::RemindOfEarlierDrives() {
  Answer last;
  const auto kind = static_cast<std::uint8_t>(RecordKind::kKeyframe);
  if (spool_->LastBefore(reminded_epoch_, kind, &last) != Status::kOk) {
    reminded_epoch_ = telemetry_->identity().epoch;  // from the newest again
    if (spool_->LastBefore(reminded_epoch_, kind, &last) != Status::kOk) return;
  }
  reminded_epoch_ = last.epoch;
  Queue(last);
}

bool AnswerQueue::LoadNext() {
  while (!queue_.empty() && !loaded_) {
    const Answer& answer = queue_.front();
    const auto bytes = spool_->Read(answer, record_);
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
    const bool is_submap = answer.kind == static_cast<std::uint8_t>(RecordKind::kSubmap);
    const std::size_t next = is_submap ? std::min(Telemetry::kChunkBytes, bytes_ - offset_) : bytes_;
    // A chunk is padded to its full size on the wire; the budget counts what leaves the machine.
    if (!budget_.TrySpend(static_cast<std::int64_t>(kCap.datagram_bytes), now)) return true;
    if (is_submap) {
      (void)telemetry_->PublishSubmapChunk(answer.epoch, answer.index, {record_.data(), bytes_}, offset_);
    } else {
      telemetry_->RepeatKeyframe({record_.data(), bytes_});
    }
    offset_ += next;
    if (offset_ < bytes_) continue;
    if (is_submap) ++submaps_sent_;
    queue_.PopFront();
    loaded_ = false;
  }
  return false;
}

}  // namespace mapweld::executive
