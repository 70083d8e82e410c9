// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/can_load.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>

#include "drivers/can/dbc_file.hpp"
#include "drivers/can/xsens_ids.hpp"

namespace mapweld::doctor {
namespace {

// From start of frame to the end of the checksum: identifier and control bits, data, 15 bits of checksum.
int StuffedBits(const CanMessage& message) {
  return (message.extended ? 54 : 34) + 8 * message.data_bytes;
}

}  // namespace

int LeastFrameBits(const CanMessage& message) {
  constexpr int kDelimitersAckEndAndSpace = 13;
  return StuffedBits(message) + kDelimitersAckEndAndSpace;
}

int MostFrameBits(const CanMessage& message) {
  return LeastFrameBits(message) + (StuffedBits(message) - 1) / 4;
}

double MostLoad(const std::vector<CanMessage>& messages, double hz) {
  double bits = 0;
  for (const CanMessage& message : messages) bits += MostFrameBits(message);
  return bits * hz;
}

std::vector<CanMessage> XsensMessages(std::string_view ids) {
  can::XsensIds parsed;
  if (!ids.empty() && can::XsensIds::Parse(ids, &parsed) != Status::kOk) {
    throw std::runtime_error("'" + std::string(ids) + "' are not five identifiers like 005,006,011,032,034");
  }
  std::vector<CanMessage> messages;
  for (std::size_t i = 0; i < parsed.all().size(); ++i) {
    const can::XsensMessage* message = can::FindXsensMessage(can::kXsensWantedIds[i]);
    messages.push_back({message->dlc, (parsed.all()[i] & can::XsensIds::kExtendedFlag) != 0});
  }
  return messages;
}

std::vector<CanMessage> DbcMessages(std::string_view dbc, std::string_view signals) {
  std::set<std::tuple<std::uint32_t, bool, int>> seen;
  while (!signals.empty()) {
    const std::string_view name = signals.substr(0, signals.find(','));
    signals.remove_prefix(std::min(name.size() + 1, signals.size()));
    can::DbcSignal signal;
    if (can::FindDbcSignal(dbc, name, &signal) != Status::kOk) {
      throw std::runtime_error("the CAN database does not describe the signal '" + std::string(name) + "' once");
    }
    seen.insert({signal.id, signal.extended, signal.dlc});
  }
  std::vector<CanMessage> messages;
  for (const auto& [id, extended, dlc] : seen) messages.push_back({dlc, extended});
  return messages;
}

}  // namespace mapweld::doctor
