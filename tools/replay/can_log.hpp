// SPDX-License-Identifier: Apache-2.0
// Reads the frames that can be sent again out of a `candump -L` log.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "drivers/can/can_frame.hpp"

namespace mapweld::replay {

class CanLog {
 public:
  // Throws std::runtime_error when the file cannot be opened.
  explicit CanLog(const std::filesystem::path& file);

  // False at the end. Error frames, remote frames and CAN FD are left out; a last line without its end is dropped.
  // Throws std::runtime_error naming file and line for anything that candump does not write.
  bool Next(can::CanFrame* frame);

 private:
  std::filesystem::path path_;
  std::ifstream stream_;
  std::string line_;
  std::int64_t line_number_ = 0;
};

}  // namespace mapweld::replay
