// SPDX-License-Identifier: Apache-2.0
// The agent's boot count. Keyframes of different boots share no frame, so a count must never be used twice, not even
// after a power failure: the new one is on the disk before it is used.
#pragma once

#include <cstdint>

#include "core/base/status.hpp"

namespace mapweld::spool {

inline constexpr const char* kEpochFile = "epoch";

// Reads <state_directory>/epoch, writes the next number durably and gives it; 1 when the file does not exist yet.
// kIo with errno when the directory is missing or not writable, kBadInput when the file does not hold a count (starting
// at 1 again could repeat an old one, so a person has to decide), kOutOfRange at the end of the numbers.
Result<std::int32_t> NextBootEpoch(const char* state_directory);

}  // namespace mapweld::spool
