// SPDX-License-Identifier: Apache-2.0
// `mapweld eval`: how far results are from the truth.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/eval/trajectory_error.hpp"

namespace mapweld::eval {

void AddEvalCommand(CLI::App& app);

// Reads the i-th truth with the i-th estimate as one vehicle, named after the estimate. TUM files meet by time; KITTI
// rows, which have none, by line. Throws one sentence with the file when they do not fit.
std::vector<Vehicle> LoadVehicles(const std::vector<std::filesystem::path>& truth,
                                  const std::vector<std::filesystem::path>& estimate);

std::string ErrorTable(const GroupError& error);
std::string ErrorJson(const GroupError& error);

}  // namespace mapweld::eval
