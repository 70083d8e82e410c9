// SPDX-License-Identifier: Apache-2.0
// Messages that agents receive.
#include <algorithm>
#include <iterator>

#include "drivers/messages/ranges.hpp"

namespace mapweld::messages {

Status Validate(const mapweldlcm::global_pose_t& m) {
  return OkIf(IsSender(m.agent_id, m.epoch) && m.keyframe >= 0 && m.group >= -1 && m.revision >= 0 &&
              IsPosition(m.merged_t_body) && IsUnitQuaternion(m.merged_q_body) && IsSize(m.sigma_m) &&
              IsSize(m.sigma_rad));
}

Status Validate(const mapweldlcm::request_t& m) {
  constexpr auto kMaxIndices = static_cast<int>(std::size(decltype(m.index){}));
  if (!IsSender(m.agent_id, m.epoch) || !Within<int>(m.n, 0, kMaxIndices)) return Status::kOutOfRange;
  const bool known = m.kind == mapweldlcm::request_t::KIND_KEYFRAME || m.kind == mapweldlcm::request_t::KIND_SUBMAP;
  return OkIf(known && std::all_of(m.index, m.index + m.n, [](std::int32_t index) { return index >= 0; }));
}

Status Validate(const mapweldlcm::command_t& m) {
  return OkIf(m.agent_id >= 1 && m.command == mapweldlcm::command_t::COMMAND_END_DRIVE);
}

}  // namespace mapweld::messages
