// SPDX-License-Identifier: Apache-2.0
// The agent's LCM transport as a program of its own, with the heap sealed: our_transport send|receive URL MESSAGES
//   send     numbered messages of 1 KiB on channel BENCH, 1000 per second
//   receive  counts them until the last is there or none comes for 5 s
// Prints what became of them. Exit code 0: all there; 3: some lost, every gap counted as dropped by the kernel; 1:
// repeated, changed, out of order, lost uncounted, not sent, or the heap was touched.
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
  std::uint32_t received = 0;
  std::uint32_t gaps = 0;  // messages missing before one that came
  std::uint32_t wrong = 0;
};

void Take(void* context, std::string_view, std::span<const std::uint8_t> got) {
  auto* inbox = static_cast<Inbox*>(context);
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4 && i < got.size(); ++i) number = number << 8U | got[i];
  Fill(number);
  if (got.size() != payload.size() || std::memcmp(got.data(), payload.data(), got.size()) != 0 ||
      number < inbox->next) {
    ++inbox->wrong;
    return;
  }
  ++inbox->received;
  inbox->gaps += number - inbox->next;
  inbox->next = number + 1;
}

int Receive(std::uint32_t messages) {
  Inbox inbox;
  pollfd waiting{.fd = transport.fd(), .events = POLLIN, .revents = 0};
  constexpr int kPatienceMs = 30'000;
  constexpr int kQuietMs = 5'000;
  while (inbox.next<messages&& ::poll(&waiting, 1, inbox.next == 0 ? kPatienceMs : kQuietMs)> 0) {
    (void)transport.Receive({.fn = Take, .context = &inbox});
  }
  const std::uint64_t dropped = transport.counters().kernel_drops;
  std::printf("ours received %u of %u, dropped by the kernel %" PRIu64 ", wrong %u, heap calls %" PRId64 "\n",
              inbox.received, messages, dropped, inbox.wrong, executive::HeapCallsAfterSeal());
  if (inbox.wrong != 0 || inbox.gaps != dropped || executive::HeapCallsAfterSeal() != 0) return 1;
  return inbox.received == messages ? 0 : 3;
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
