// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "core/base/status.hpp"

namespace mapweld::executive {

// Files that describe a sensor: calibrations, signal databases.
inline constexpr std::size_t kMaxSetupFileBytes = 256 << 10;

// The whole file into `buffer`. kIo with errno, kFull when it does not fit.
Status ReadFile(const char* path, std::span<char> buffer, std::size_t* bytes);

}  // namespace mapweld::executive
