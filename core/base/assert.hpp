// SPDX-License-Identifier: Apache-2.0
// MAPWELD_ASSERT is for our own bugs only, never for input. It stays on in every build: a vehicle that restarts from a
// watchdog is safer than one that goes on with a broken invariant.
#pragma once

namespace mapweld {

// Called with the failed expression and its place; must not return. The executive installs one that writes a fault
// record; without one the process traps.
using AssertHandler = void (*)(const char* expression, const char* file, int line);
void SetAssertHandler(AssertHandler handler);

[[noreturn]] void AssertFailed(const char* expression, const char* file, int line);

}  // namespace mapweld

#define MAPWELD_ASSERT(expression)     \
  ((expression) ? static_cast<void>(0) \
                : ::mapweld::AssertFailed(#expression, __FILE__, __LINE__))  // NOLINT(cppcoreguidelines-macro-usage)
