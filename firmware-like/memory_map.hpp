// SPDX-License-Identifier: Apache-2.0
// All long-lived memory of the agent, in one place and of one size.
#pragma once

#include "core/config/capacity.hpp"
#include "firmware-like/agent.hpp"

namespace mapweld::executive {

struct AgentMemory {
  AgentMemory(const Options& options, std::int32_t epoch) : agent(options, epoch) {}

  Agent agent;
};

static_assert(sizeof(AgentMemory) <= kRamBudgetBytes, "the agent has outgrown its budget");

}  // namespace mapweld::executive
