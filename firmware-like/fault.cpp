// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/fault.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

#include "core/base/assert.hpp"

namespace mapweld::executive {
namespace {

int g_fault_fd = -1;

void Record(const char* expression, const char* file, int line) {
  char text[512];
  const int n =
      std::snprintf(text, sizeof(text), "mapweld-agent: broken invariant '%s' at %s:%d\n", expression, file, line);
  if (n <= 0) return;
  const auto bytes = static_cast<std::size_t>(n) < sizeof(text) ? static_cast<std::size_t>(n) : sizeof(text) - 1;
  (void)!write(STDERR_FILENO, text, bytes);
  if (g_fault_fd >= 0) {
    (void)!write(g_fault_fd, text, bytes);
    (void)fsync(g_fault_fd);
  }
}

}  // namespace

void InstallFaultRecorder(const char* state_dir) {
  char path[512];
  const int n = std::snprintf(path, sizeof(path), "%s/fault", state_dir);
  if (n > 0 && static_cast<std::size_t>(n) < sizeof(path))
    g_fault_fd = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  SetAssertHandler(&Record);
}

}  // namespace mapweld::executive
