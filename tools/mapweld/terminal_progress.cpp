// SPDX-License-Identifier: Apache-2.0
#include "tools/mapweld/terminal_progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace mapweld::merge {

TerminalProgress::TerminalProgress(std::string command)
    : command_(std::move(command)), terminal_(isatty(STDERR_FILENO) != 0) {}

void TerminalProgress::Report(std::string_view stage, int done, int total) {
  const auto now = std::chrono::steady_clock::now();
  const bool finished = done >= total;
  const auto pause = terminal_ ? std::chrono::milliseconds(100) : std::chrono::seconds(10);
  if (silent_ || (!finished && now - last_ < pause)) return;
  last_ = now;
  const std::string text =
      fmt::format("{}: {}{}{} {}/{}", command_, subject_, subject_.empty() ? "" : ": ", stage, done, total);
  if (terminal_) fmt::print(stderr, "\r\033[K{}{}", text, finished ? "\n" : "");
  if (!terminal_) fmt::print(stderr, "{}\n", text);
  line_open_ = terminal_ && !finished;
}

void TerminalProgress::Finish() {
  if (line_open_) std::fputc('\n', stderr);
  line_open_ = false;
}

}  // namespace mapweld::merge
