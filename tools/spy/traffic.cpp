// SPDX-License-Identifier: Apache-2.0
#include "tools/spy/traffic.hpp"

#include <algorithm>
#include <cmath>

#include "tools/spy/message_type.hpp"

namespace mapweld::spy {
namespace {

constexpr std::size_t kMostSenders = 1000;
constexpr std::size_t kMostChannels = 1000;  // per sender
constexpr std::string_view kOthers = "(others)";

}  // namespace

void Traffic::Count(TimeNs t, std::string_view name, std::span<const std::uint8_t> begin, std::size_t bytes,
                    Speaker* speaker) {
  auto channel = speaker->channels.find(name);
  if (channel == speaker->channels.end() && speaker->channels.size() >= kMostChannels) {
    channel = speaker->channels.find(name = kOthers);
  }
  if (channel == speaker->channels.end()) channel = speaker->channels.emplace(name, Channel{}).first;
  ++speaker->messages;
  ++channel->second.messages;
  channel->second.type = TypeName(begin);
  if (!AgentsWouldTake(name, begin)) ++channel->second.refused;
  channel->second.recent.push_back({t, bytes});
}

void Traffic::TakeFragment(TimeNs t, const bus::ParsedDatagram& datagram, Speaker* speaker) {
  auto found = speaker->partial.find(datagram.sequence);
  if (found == speaker->partial.end()) {
    if (!speaker->numbers.Take(datagram.sequence)) {
      ++speaker->repeated;
      return;
    }
    if (speaker->partial_order.size() == kPartialMessages) {
      speaker->incomplete += speaker->partial.erase(speaker->partial_order.front());
      speaker->partial_order.pop_front();
    }
    found = speaker->partial.emplace(datagram.sequence, Partial{}).first;
    found->second.present.assign(datagram.fragments, false);
    found->second.missing = datagram.fragments;
    speaker->partial_order.push_back(datagram.sequence);
  }
  Partial& partial = found->second;
  if (datagram.fragment_index >= partial.present.size() || partial.present[datagram.fragment_index]) return;
  partial.present[datagram.fragment_index] = true;
  --partial.missing;
  if (datagram.fragment_index == 0) {
    partial.channel = datagram.channel;
    partial.begin.assign(datagram.payload.begin(), datagram.payload.end());
  }
  if (partial.missing > 0) return;
  Count(t, partial.channel, partial.begin, datagram.message_bytes, speaker);
  speaker->partial.erase(found);
  std::erase(speaker->partial_order, datagram.sequence);
}

void Traffic::Take(TimeNs t, const Sender& sender, std::span<const std::uint8_t> datagram) {
  bus::ParsedDatagram parsed;
  if (bus::ParseDatagram(datagram, &parsed) != bus::Refusal::kNone) {
    ++not_lcm_;
    return;
  }
  // A flood of forged senders or channels must not take the machine's memory.
  Speaker& speaker = speakers_[speakers_.size() < kMostSenders || speakers_.contains(sender) ? sender : Sender{}];
  if (parsed.fragment) {
    TakeFragment(t, parsed, &speaker);
  } else if (speaker.numbers.Take(parsed.sequence)) {
    Count(t, parsed.channel, parsed.payload, parsed.payload.size(), &speaker);
  } else {
    ++speaker.repeated;
  }
}

ChannelReport Traffic::ReportOf(const std::string& name, Channel* channel, TimeNs now) const {
  std::deque<Message>& recent = channel->recent;
  while (!recent.empty() && now - recent.front().t > window_) recent.pop_front();
  ChannelReport report{
      .channel = name, .type = channel->type, .messages = channel->messages, .refused = channel->refused};
  const double seconds = std::max(std::min(now - start_, window_).Seconds(), 1e-9);
  double sum = 0;
  double sum_of_squares = 0;
  for (std::size_t i = 0; i < recent.size(); ++i) {
    report.bytes_per_s += static_cast<double>(recent[i].bytes) / seconds;
    if (i == 0) continue;
    const double ms = (recent[i].t - recent[i - 1].t).Seconds() * 1e3;
    sum += ms;
    sum_of_squares += ms * ms;
    report.longest_ms = std::max(report.longest_ms, ms);
  }
  report.hz = static_cast<double>(recent.size()) / seconds;
  if (recent.size() < 2) return report;
  const double n = static_cast<double>(recent.size() - 1);
  report.jitter_ms = std::sqrt(std::max(sum_of_squares / n - (sum / n) * (sum / n), 0.0));
  return report;
}

TrafficReport Traffic::Report(TimeNs now) {
  TrafficReport report{.seconds = (now - start_).Seconds(), .not_lcm = not_lcm_, .senders = {}};
  for (auto& [sender, speaker] : speakers_) {
    SenderReport& row = report.senders.emplace_back(SenderReport{.sender = sender,
                                                                 .messages = speaker.messages,
                                                                 .lost = speaker.numbers.missing() + speaker.incomplete,
                                                                 .repeated = speaker.repeated,
                                                                 .channels = {}});
    for (auto& [name, channel] : speaker.channels) row.channels.push_back(ReportOf(name, &channel, now));
  }
  return report;
}

}  // namespace mapweld::spy
