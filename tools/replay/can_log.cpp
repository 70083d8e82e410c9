// SPDX-License-Identifier: Apache-2.0
#include "tools/replay/can_log.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

#include "drivers/can/candump_line.hpp"

namespace mapweld::replay {

CanLog::CanLog(const std::filesystem::path& file) : path_(file), stream_(file) {
  if (!stream_) throw std::runtime_error(fmt::format("cannot open CAN log {}", file.string()));
}

bool CanLog::Next(can::CanFrame* frame) {
  while (std::getline(stream_, line_)) {
    ++line_number_;
    if (line_.empty()) continue;
    std::string_view interface;
    const Status status = can::ParseCandumpLine(line_, frame, &interface);
    if (status == Status::kOk && !frame->error && !frame->remote) return true;
    if (status == Status::kOk || status == Status::kVersion) continue;
    if (stream_.eof()) return false;  // the recorder was stopped within this line
    throw std::runtime_error(
        fmt::format("{}, line {}: '{}' is no line of candump -L, such as '(1436509052.249713) can0 034#00FF01020304'",
                    path_.string(), line_number_, line_.substr(0, 80)));
  }
  return false;
}

}  // namespace mapweld::replay
