// SPDX-License-Identifier: Apache-2.0
// How much of a CAN bus a set of periodic messages takes.
#pragma once

#include <string_view>
#include <vector>

namespace mapweld::doctor {

struct CanMessage {
  int data_bytes = 0;     // 0..8
  bool extended = false;  // 29-bit identifier
};

// Bits of one classic frame on the wire, interframe space included: without stuff bits, and with as many as there can
// be (one after every four bits of the stuffed part). Source: ISO 11898-1.
int LeastFrameBits(const CanMessage& message);
int MostFrameBits(const CanMessage& message);

// Bits per second at most, of all messages sent `hz` times per second.
double MostLoad(const std::vector<CanMessage>& messages, double hz);

// What the agent needs of an Xsens MTi, one frame of each per sample. `ids`: see XsensIds::Parse, empty: the device's
// own; throws one sentence when it is no such list.
std::vector<CanMessage> XsensMessages(std::string_view ids = {});
// What it needs of an IMU that a .dbc file describes; throws one sentence when the file does not.
std::vector<CanMessage> DbcMessages(std::string_view dbc, std::string_view signals);

}  // namespace mapweld::doctor
