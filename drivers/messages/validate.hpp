// SPDX-License-Identifier: Apache-2.0
// The ranges of every field of every message, checked both before sending and after receiving. kOutOfRange names
// nothing more: a message is good as a whole or refused as a whole. Reals are finite, quaternions have unit length.
#pragma once

#include <mapweldlcm/command_t.hpp>
#include <mapweldlcm/global_pose_t.hpp>
#include <mapweldlcm/health_t.hpp>
#include <mapweldlcm/keyframe_t.hpp>
#include <mapweldlcm/pose_t.hpp>
#include <mapweldlcm/request_t.hpp>
#include <mapweldlcm/submap_chunk_t.hpp>

#include "core/base/status.hpp"

namespace mapweld::messages {

inline constexpr double kMaxPositionM = 1e7;        // a quarter of the way around the Earth
inline constexpr double kUnitNormTolerance = 1e-3;  // of a quaternion's length

Status Validate(const mapweldlcm::keyframe_t& message);
Status Validate(const mapweldlcm::submap_chunk_t& message);
Status Validate(const mapweldlcm::pose_t& message);
Status Validate(const mapweldlcm::health_t& message);
Status Validate(const mapweldlcm::global_pose_t& message);
Status Validate(const mapweldlcm::request_t& message);
Status Validate(const mapweldlcm::command_t& message);

}  // namespace mapweld::messages
