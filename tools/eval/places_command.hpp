// SPDX-License-Identifier: Apache-2.0
// mapweld eval places INPUT...: how well descriptors recognise places.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/eval/place_score.hpp"

namespace mapweld::eval {

void AddPlacesCommand(CLI::App& eval);

struct VariantScore {
  std::string variant;
  int sessions = 0;
  int keyframes = 0;
  int refused = 0;                // keyframes without descriptor; they count as missed
  std::optional<int> unfamiliar;  // keyframes unlike what the descriptor was trained on, where that is known
  PlaceScore score;
};

std::string PlaceTable(const std::vector<VariantScore>& scores);
std::string PlaceJson(const std::vector<VariantScore>& scores);

}  // namespace mapweld::eval
