// SPDX-License-Identifier: Apache-2.0
// Every descriptor that can be asked for by name. A new one is one line in variants.cpp.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tools/describe/place_method.hpp"

namespace mapweld::describe {

// Ours first, then the published ones.
std::vector<std::string> VariantNames();

// One sentence with the names there are, for help texts and errors.
std::string VariantList();

bool IsVariant(std::string_view name);

// Throws std::runtime_error for a name that there is not.
std::unique_ptr<PlaceMethod> MakeVariant(std::string_view name);

// Compares by the cosine of all 1024 bytes and describes nothing: for tables that something else has written.
std::unique_ptr<PlaceMethod> MakeCosineComparison();

}  // namespace mapweld::describe
