// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <thread>

namespace mapweld {

// While it lives, SIGINT and SIGTERM end the program at once, whatever it does: with one sentence, without half-written
// files beside the output, exit code 128 + signal. Create it before any other thread. A store needs no help: what it
// had acknowledged stays.
class CleanInterrupt {
 public:
  explicit CleanInterrupt(std::string sentence);
  ~CleanInterrupt();
  CleanInterrupt(const CleanInterrupt&) = delete;
  CleanInterrupt& operator=(const CleanInterrupt&) = delete;

 private:
  std::string sentence_;
  std::thread thread_;
};

}  // namespace mapweld
