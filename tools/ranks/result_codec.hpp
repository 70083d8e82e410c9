// SPDX-License-Identifier: Apache-2.0
// What the jobs of a merge give, as bytes and back, exactly: what is read is what was written, to the last bit. Linear
// in the bytes. Decode throws std::runtime_error for what no Encode wrote.
#pragma once

#include <span>
#include <vector>

#include "tools/merge/crew.hpp"
#include "tools/store/database.hpp"

namespace mapweld::ranks {

store::Bytes Encode(const std::vector<merge::Association>& associations);
store::Bytes Encode(const merge::PairOutcome& outcome);
store::Bytes Encode(const merge::PairRefinement& refinement);
store::Bytes Encode(const merge::GroupSolution& solution);

void Decode(std::span<const std::uint8_t> bytes, std::vector<merge::Association>* out);
void Decode(std::span<const std::uint8_t> bytes, merge::PairOutcome* out);
void Decode(std::span<const std::uint8_t> bytes, merge::PairRefinement* out);
void Decode(std::span<const std::uint8_t> bytes, merge::GroupSolution* out);

// Several results in one.
store::Bytes Pack(const std::vector<store::Bytes>& results);
std::vector<store::Bytes> Unpack(std::span<const std::uint8_t> bytes);

}  // namespace mapweld::ranks
