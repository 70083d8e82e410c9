// SPDX-License-Identifier: Apache-2.0
#include "tools/spy/traffic_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace mapweld::spy {
namespace {

// Channel names come from the network: nothing in them may reach the terminal as a command, or break the JSON.
std::string Printable(std::string_view text) {
  std::string out;
  for (const char c : text) out += c >= ' ' && c <= '~' ? c : '?';
  return out;
}

std::string Address(const Sender& sender) {
  return fmt::format("{}.{}.{}.{}:{}", sender.ipv4 >> 24U, sender.ipv4 >> 16U & 255U, sender.ipv4 >> 8U & 255U,
                     sender.ipv4 & 255U, sender.port);
}

}  // namespace

std::string TrafficTable(const TrafficReport& report, const std::string& lcm_url, std::uint64_t missed) {
  std::string out = fmt::format("{}, {:.0f} s\n", lcm_url, report.seconds);
  if (report.senders.empty()) out += "nobody has said anything\n";
  std::size_t width = 24;
  std::size_t type_width = 14;
  for (const SenderReport& sender : report.senders) {
    for (const ChannelReport& c : sender.channels) {
      width = std::max(width, c.channel.size() + 2);
      type_width = std::max(type_width, c.type.size());
    }
  }
  if (!report.senders.empty()) {
    out += fmt::format("{:<{}}  {:<{}} {:>9} {:>8} {:>11} {:>10} {:>11} {:>7} {:>6}\n", "sender, channel", width,
                       "type", type_width, "messages", "Hz", "bytes/s", "jitter ms", "longest ms", "refused", "lost");
  }
  for (const SenderReport& sender : report.senders) {
    out += fmt::format("{:<{}}  {:<{}} {:>9} {:>8} {:>11} {:>10} {:>11} {:>7} {:>6}\n", Address(sender.sender), width,
                       "", type_width, sender.messages, "", "", "", "", "", sender.lost);
    for (const ChannelReport& c : sender.channels) {
      out += fmt::format("  {:<{}}  {:<{}} {:>9} {:>8.2f} {:>11.0f} {:>10.2f} {:>11.2f} {:>7}\n", Printable(c.channel),
                         width - 2, c.type, type_width, c.messages, c.hz, c.bytes_per_s, c.jitter_ms, c.longest_ms,
                         c.refused);
    }
  }
  if (report.not_lcm > 0) out += fmt::format("{} datagrams were not LCM's\n", report.not_lcm);
  if (missed > 0) out += fmt::format("{} datagrams were missed here, on this busy machine, and look lost\n", missed);
  return out;
}

std::string TrafficJson(const TrafficReport& report, const std::string& lcm_url, std::uint64_t missed) {
  nlohmann::ordered_json json{{"lcm_url", lcm_url},
                              {"seconds", report.seconds},
                              {"missed_here", missed},
                              {"not_lcm", report.not_lcm},
                              {"senders", nlohmann::ordered_json::array()}};
  for (const SenderReport& sender : report.senders) {
    nlohmann::ordered_json row{{"address", Address(sender.sender)},
                               {"messages", sender.messages},
                               {"lost", sender.lost},
                               {"repeated", sender.repeated},
                               {"channels", nlohmann::ordered_json::array()}};
    for (const ChannelReport& c : sender.channels) {
      row["channels"].push_back({{"channel", Printable(c.channel)},
                                 {"type", c.type},
                                 {"messages", c.messages},
                                 {"refused", c.refused},
                                 {"hz", c.hz},
                                 {"bytes_per_s", c.bytes_per_s},
                                 {"jitter_ms", c.jitter_ms},
                                 {"longest_ms", c.longest_ms}});
    }
    json["senders"].push_back(row);
  }
  return json.dump(2) + "\n";
}

}  // namespace mapweld::spy
