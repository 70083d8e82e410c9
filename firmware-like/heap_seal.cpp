// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/heap_seal.hpp"

#include <unistd.h>

#include <atomic>

namespace mapweld::executive {
namespace {
std::atomic<bool> g_watched{false};
std::atomic<bool> g_sealed{false};
std::atomic<bool> g_abort{false};
std::atomic<std::int64_t> g_calls{0};
}  // namespace

void SealHeap(bool abort_on_call) {
  g_abort.store(abort_on_call);
  g_sealed.store(true);
}

std::int64_t HeapCallsAfterSeal() {
  return g_watched.load() ? g_calls.load() : -1;
}

void WatchHeap() {
  g_watched.store(true);
}

void NoteHeapCall() {
  if (!g_sealed.load(std::memory_order_relaxed)) return;
  g_calls.fetch_add(1, std::memory_order_relaxed);
  if (!g_abort.load(std::memory_order_relaxed)) return;
  static constexpr char kText[] = "mapweld-agent: heap call after the seal\n";
  (void)!write(STDERR_FILENO, kText, sizeof(kText) - 1);
  __builtin_trap();
}

}  // namespace mapweld::executive
