// SPDX-License-Identifier: Apache-2.0
// The replayer's side of the wires to one agent. An interface, so that the flow control can be tested against an agent
// that loses, stalls or restarts, in simulated time.
#pragma once

#include <cstdint>
#include <mapweldlcm/health_t.hpp>
#include <optional>
#include <span>

#include "drivers/can/can_frame.hpp"

namespace mapweld::replay {

class AgentLink {
 public:
  virtual ~AgentLink() = default;

  virtual void SendLidar(std::span<const std::uint8_t> datagram) = 0;
  virtual void SendCan(const can::CanFrame& frame) = 0;
  virtual void SendEndDrive() = 0;

  // Waits until a health message arrives, at most max_s seconds; 0: only takes what is there.
  virtual void Wait(double max_s) = 0;
  // Lets time pass exactly, for pacing; takes messages meanwhile.
  virtual void SleepUntil(double time_s) = 0;
  [[nodiscard]] virtual const std::optional<mapweldlcm::health_t>& health() const = 0;  // the newest
  [[nodiscard]] virtual double Now_s() const = 0;                                       // steady clock
};

}  // namespace mapweld::replay
