// SPDX-License-Identifier: Apache-2.0
#include "tools/mapweld/interrupt.hpp"

#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "tools/io/atomic_file.hpp"

namespace mapweld {
namespace {

sigset_t Signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) sigaddset(&set, signal);  // SIGUSR1: nobody needs us any more
  return set;
}

}  // namespace

CleanInterrupt::CleanInterrupt(std::string sentence) : sentence_(std::move(sentence)) {
  const sigset_t set = Signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);  // for the threads to come as well
  thread_ = std::thread([this, set] {
    int signal = 0;
    if (sigwait(&set, &signal) != 0 || signal == SIGUSR1) return;
    io::AtomicFile::RemoveTemporaries();
    std::fprintf(stderr, "\n%s\n", sentence_.c_str());
    ::_exit(128 + signal);
  });
}

CleanInterrupt::~CleanInterrupt() {
  pthread_kill(thread_.native_handle(), SIGUSR1);
  thread_.join();
  const sigset_t set = Signals();
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

}  // namespace mapweld
