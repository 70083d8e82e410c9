// SPDX-License-Identifier: Apache-2.0
// Who says what on an LCM network, how often, how regularly, and what of it was lost. Fed with datagrams; asks no
// clock.
#pragma once

#include <compare>
#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/time.hpp"
#include "drivers/bus/udpm_wire.hpp"
#include "tools/spy/sequence_tracker.hpp"

namespace mapweld::spy {

struct Sender {
  std::uint32_t ipv4 = 0;  // host byte order
  std::uint16_t port = 0;
  auto operator<=>(const Sender&) const = default;
};

// Rates and times are of the last `window`, counts of the whole time.
struct ChannelReport {
  std::string channel;
  std::string type;  // of ours by name, others by the fingerprint that lcm-gen gives them
  std::uint64_t messages = 0;
  std::uint64_t refused = 0;  // on a channel of ours, but the agents would not take it
  double hz = 0;
  double bytes_per_s = 0;  // payload
  double jitter_ms = 0;    // standard deviation of the time between two messages
  double longest_ms = 0;   // between two messages
};

struct SenderReport {
  Sender sender;
  std::uint64_t messages = 0;
  std::uint64_t lost = 0;      // numbers that never came, and messages of which a fragment never came
  std::uint64_t repeated = 0;  // came again
  std::vector<ChannelReport> channels;
};

struct TrafficReport {
  double seconds = 0;                 // observed
  std::uint64_t not_lcm = 0;          // datagrams that no LCM program can have sent
  std::vector<SenderReport> senders;  // by address
};

class Traffic {
 public:
  Traffic(TimeNs start, DurationNs window) : start_(start), window_(window) {}

  void Take(TimeNs t, const Sender& sender, std::span<const std::uint8_t> datagram);
  [[nodiscard]] TrafficReport Report(TimeNs now);

 private:
  static constexpr std::size_t kPartialMessages = 64;  // per sender; the oldest gives way and is lost

  struct Message {
    TimeNs t;
    std::size_t bytes;
  };
  struct Channel {
    std::string type;
    std::uint64_t messages = 0;
    std::uint64_t refused = 0;
    std::deque<Message> recent;
  };
  struct Partial {
    std::vector<bool> present;
    std::size_t missing = 0;
    std::string channel;
    std::vector<std::uint8_t> begin;  // of the payload: what fragment 0 carried
  };
  struct Speaker {
    SequenceTracker numbers;
    std::uint64_t messages = 0;
    std::uint64_t incomplete = 0;
    std::uint64_t repeated = 0;
    std::map<std::string, Channel, std::less<>> channels;
    std::map<std::uint32_t, Partial> partial;
    std::deque<std::uint32_t> partial_order;
  };

  void TakeFragment(TimeNs t, const bus::ParsedDatagram& datagram, Speaker* speaker);
  static void Count(TimeNs t, std::string_view channel, std::span<const std::uint8_t> begin, std::size_t bytes,
                    Speaker* speaker);
  ChannelReport ReportOf(const std::string& name, Channel* channel, TimeNs now) const;

  TimeNs start_;
  DurationNs window_;
  std::uint64_t not_lcm_ = 0;
  std::map<Sender, Speaker> speakers_;
};

}  // namespace mapweld::spy
