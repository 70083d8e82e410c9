// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace mapweld::doctor {

// Runs `ip -json ARGUMENTS` (package iproute2) without a shell. An empty array when it refuses; *complaint is then what
// it said. Throws one sentence when there is no such program.
nlohmann::json RunIp(const std::vector<std::string>& arguments, std::string* complaint);

}  // namespace mapweld::doctor
