// SPDX-License-Identifier: Apache-2.0
// Where CAN frames come from: a bus or a recording.
#pragma once

#include <cstddef>
#include <span>

#include "core/base/status.hpp"
#include "drivers/can/can_frame.hpp"

namespace mapweld::can {

class CanPort {
 public:
  CanPort() = default;
  CanPort(const CanPort&) = delete;
  CanPort& operator=(const CanPort&) = delete;

  // Takes what is there, at most out.size() frames, without waiting. kOk also with *n == 0; kNotReady while the
  // interface is down (the port recovers by itself), kEmpty at the end of a recording, kIo with errno otherwise.
  virtual Status Receive(std::span<CanFrame> out, std::size_t* n) = 0;

  // For epoll; -1 when closed. A recording has a file's descriptor, which epoll does not take.
  [[nodiscard]] virtual int fd() const = 0;

 protected:
  // Ports live in the agent's static memory and are never deleted through this type.
  ~CanPort() = default;
};

}  // namespace mapweld::can
