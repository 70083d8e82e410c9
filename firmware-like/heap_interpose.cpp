// SPDX-License-Identifier: Apache-2.0
// Stands between the program and glibc's allocator to count calls. Linked into programs, not into a library: the
// archives of the agent must not mention the allocator at all.
#include <cerrno>
#include <cstddef>

#include "firmware-like/heap_seal.hpp"

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t n, std::size_t size);
void* __libc_realloc(void* p, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* p);

void* malloc(std::size_t size) {
  mapweld::executive::NoteHeapCall();
  return __libc_malloc(size);
}
void* calloc(std::size_t n, std::size_t size) {
  mapweld::executive::NoteHeapCall();
  return __libc_calloc(n, size);
}
void* realloc(void* p, std::size_t size) {
  mapweld::executive::NoteHeapCall();
  return __libc_realloc(p, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  mapweld::executive::NoteHeapCall();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  mapweld::executive::NoteHeapCall();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  mapweld::executive::NoteHeapCall();
  *out = __libc_memalign(alignment, size);
  return *out == nullptr ? ENOMEM : 0;
}
void free(void* p) {
  __libc_free(p);
}
}

namespace {
// Runs before main: the count is worth something only where this file is linked.
const bool g_watching = (mapweld::executive::WatchHeap(), true);
}  // namespace
