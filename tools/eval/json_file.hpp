// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace mapweld::eval {

// Parses `file` and hands it to `read`; whatever goes wrong, the message names the file.
template <class Read>
void WithJson(const std::filesystem::path& file, const Read& read) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(fmt::format("cannot open {}", file.string()));
  try {
    read(nlohmann::ordered_json::parse(stream));
  } catch (const nlohmann::ordered_json::exception& error) {
    throw std::runtime_error(fmt::format("{} is not what it should be: {}", file.string(), error.what()));
  }
}

}  // namespace mapweld::eval
