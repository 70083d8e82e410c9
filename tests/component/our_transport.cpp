// SPDX-License-Identifier: Apache-2.0
// The agent's LCM transport as a program of its own, with the heap sealed: our_transport send|receive URL MESSAGES
//   send     numbered messages of 1 KiB on channel BENCH, 1000 per second
//   receive  counts them until all are there or none comes for 5 s
// Prints what became of them; exit code 0 when none was lost, repeated, changed or out of order and the heap was not
// touched.
#include <poll.h>

#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "core/base/byte_io.hpp"
#include "drivers/bus/udpm_bus.hpp"
#include "drivers/time/monotonic_clock.hpp"
#include "firmware-like/heap_seal.hpp"

namespace {

using namespace mapweld;

constexpr std::size_t kPayloadBytes = 1024;
constexpr std::int64_t kPeriodNs = 1'000'000;

bus::UdpmBus transport;
std::array<std::uint8_t, kPayloadBytes> payload;

// The n-th message: its number, then bytes that follow from it.
void Fill(std::uint32_t n) {
  for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = static_cast<std::uint8_t>(n * 7 + i * 31);
  ByteWriter(payload).Big(n);
}

int Send(std::uint32_t messages) {
  std::uint32_t failed = 0;
  TimeNs next = time::MonotonicNow();
  for (std::uint32_t n = 0; n < messages; ++n) {
    Fill(n);
    if (transport.Publish("BENCH", payload) != Status::kOk) ++failed;
    next = next + DurationNs{kPeriodNs};
    const timespec until{.tv_sec = next.ns / 1'000'000'000, .tv_nsec = next.ns % 1'000'000'000};
    (void)::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
  }
  std::printf("ours sent %u, failed %u, heap calls %" PRId64 "\n", messages, failed, executive::HeapCallsAfterSeal());
  return failed == 0 && executive::HeapCallsAfterSeal() == 0 ? 0 : 1;
}

struct Inbox {
  std::uint32_t next = 0;
  std::uint32_t wrong = 0;
};

void Take(void* context, std::string_view, std::span<const std::uint8_t> got) {
  auto* inbox = static_cast<Inbox*>(context);
  Fill(inbox->next++);
  if (got.size() != payload.size() || std::memcmp(got.data(), payload.data(), got.size()) != 0) ++inbox->wrong;
}

int Receive(std::uint32_t messages) {
  Inbox inbox;
  pollfd waiting{.fd = transport.fd(), .events = POLLIN, .revents = 0};
  constexpr int kPatienceMs = 30'000;
  constexpr int kQuietMs = 5'000;
  while (inbox.next<messages&& ::poll(&waiting, 1, inbox.next == 0 ? kPatienceMs : kQuietMs)> 0) {
    (void)transport.Receive({.fn = Take, .context = &inbox});
  }
  std::printf("ours received %u of %u, wrong %u, heap calls %" PRId64 "\n", inbox.next, messages, inbox.wrong,
              executive::HeapCallsAfterSeal());
  return inbox.next == messages && inbox.wrong == 0 && executive::HeapCallsAfterSeal() == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4 || transport.Open(argv[2], "BENCH") != Status::kOk) {
    std::perror("our_transport send|receive URL MESSAGES");
    return 2;
  }
  const auto messages = static_cast<std::uint32_t>(std::strtoul(argv[3], nullptr, 10));
  std::puts("ready");  // allocates the buffer of stdout
  std::fflush(stdout);
  executive::SealHeap(false);
  return std::strcmp(argv[1], "send") == 0 ? Send(messages) : Receive(messages);
}
