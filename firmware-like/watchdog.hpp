// SPDX-License-Identifier: Apache-2.0
// Tells systemd that the agent is ready and alive (sd_notify protocol: one datagram to $NOTIFY_SOCKET). Does nothing
// when the variable is not set.
#pragma once

namespace mapweld::executive {

class Watchdog {
 public:
  Watchdog() = default;
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  void Open();
  void Ready() { Send("READY=1"); }
  // Call only when every part of the loop has run since the last call.
  void Alive() { Send("WATCHDOG=1"); }
  void Stopping() { Send("STOPPING=1"); }

 private:
  void Send(const char* text) const;
  int fd_ = -1;
};

}  // namespace mapweld::executive
