// SPDX-License-Identifier: Apache-2.0
// Spreads independent jobs over threads. Results stay deterministic as long as job i writes only to slot i.
#pragma once

#include <functional>

namespace mapweld::merge {

// The threads to use for a setting of `threads`: itself, or the machine's number for 0.
int ThreadCount(int threads);

// Calls job(i) once for every i in 0..count-1, on at most `threads` threads, and waits for all. When jobs throw, the
// exception of the lowest i is thrown again after the others have ended, so that the error does not depend on timing.
void ParallelFor(int count, int threads, const std::function<void(int)>& job);

}  // namespace mapweld::merge
