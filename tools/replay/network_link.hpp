// SPDX-License-Identifier: Apache-2.0
// The real wires: UDP for LiDAR datagrams, a raw SocketCAN socket for frames, LCM for health and commands.
#pragma once

#include <netinet/in.h>

#include <lcm/lcm-cpp.hpp>
#include <string>

#include "tools/replay/agent_link.hpp"

namespace mapweld::replay {

struct NetworkOptions {
  int agent_id = 0;
  std::string host = "127.0.0.1";  // IPv4 address or name
  std::uint16_t lidar_port = 2368;
  std::string can_interface;  // empty: no CAN
  std::string lcm_url;        // empty: LCM_DEFAULT_URL, else LCM's own default
};

class NetworkLink final : public AgentLink {
 public:
  // Throws std::runtime_error naming what cannot be opened and why.
  explicit NetworkLink(const NetworkOptions& options);
  ~NetworkLink() override;
  NetworkLink(const NetworkLink&) = delete;
  NetworkLink& operator=(const NetworkLink&) = delete;

  void SendLidar(std::span<const std::uint8_t> datagram) override;
  void SendCan(const can::CanFrame& frame) override;
  void SendEndDrive() override;
  void Wait(double max_s) override;
  void SleepUntil(double time_s) override;
  [[nodiscard]] const std::optional<mapweldlcm::health_t>& health() const override { return health_; }
  [[nodiscard]] double Now_s() const override;

 private:
  void OnHealth(const lcm::ReceiveBuffer* buffer, const std::string& channel, const mapweldlcm::health_t* message);
  NetworkOptions options_;
  lcm::LCM lcm_;
  int udp_fd_ = -1;
  int can_fd_ = -1;
  sockaddr_in to_{};
  std::optional<mapweldlcm::health_t> health_;
};

}  // namespace mapweld::replay
