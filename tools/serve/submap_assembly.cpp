// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/submap_assembly.hpp"

#include <algorithm>

namespace mapweld::serve {

std::optional<std::vector<std::uint8_t>> SubmapAssembly::Add(const mapweldlcm::submap_chunk_t& piece) {
  const std::pair key(DriveId{piece.agent_id, piece.epoch}, piece.keyframe);
  Partial& partial = partial_[key];
  const auto total = static_cast<std::size_t>(piece.total_bytes);
  if (partial.bytes.size() != total) {  // the first piece, or an agent that contradicts itself: start over
    partial = {};
    partial.bytes.resize(total);
  }
  if (!partial.pieces.emplace(piece.offset, piece.n).second) {
    ++repeated_;
    return std::nullopt;
  }
  std::copy_n(piece.data, piece.n, partial.bytes.begin() + piece.offset);
  std::int32_t covered = 0;
  for (const auto& [offset, n] : partial.pieces) {
    if (offset > covered) return std::nullopt;
    covered = std::max(covered, offset + n);
  }
  if (static_cast<std::size_t>(covered) < total) return std::nullopt;
  std::vector<std::uint8_t> whole = std::move(partial.bytes);
  partial_.erase(key);
  return whole;
}

}  // namespace mapweld::serve
