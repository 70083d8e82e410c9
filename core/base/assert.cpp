// SPDX-License-Identifier: Apache-2.0
#include "core/base/assert.hpp"

namespace mapweld {
namespace {
AssertHandler g_handler = nullptr;
}

void SetAssertHandler(AssertHandler handler) {
  g_handler = handler;
}

void AssertFailed(const char* expression, const char* file, int line) {
  if (g_handler != nullptr) g_handler(expression, file, line);
  __builtin_trap();
}

}  // namespace mapweld
