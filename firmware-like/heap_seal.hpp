// SPDX-License-Identifier: Apache-2.0
// After boot the agent must not allocate. The programs that link heap_interpose.cpp count every call to the allocator
// after SealHeap(); with the environment variable MAPWELD_HEAP_ABORT set the first one ends the process.
#pragma once

#include <cstdint>

namespace mapweld::executive {

// From now on allocations are counted. Safe to call once, from any thread.
void SealHeap(bool abort_on_call);

// Allocations since the seal. -1 when this program does not watch its allocator (sanitizer builds).
std::int64_t HeapCallsAfterSeal();

// For the interposer only.
void WatchHeap();
void NoteHeapCall();

}  // namespace mapweld::executive
