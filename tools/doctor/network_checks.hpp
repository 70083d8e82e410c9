// SPDX-License-Identifier: Apache-2.0
// The LCM network and the sockets: route, TTL, a message to ourselves, receive buffers, the LiDAR's port.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "drivers/bus/lcm_url.hpp"
#include "tools/doctor/finding.hpp"

namespace mapweld::doctor {

// `routes`: `ip -json route get GROUP`, or `complaint`: what it said instead. `outward`: the interface towards the
// host.
Finding CheckRoute(const bus::UdpmAddress& address, const nlohmann::json& routes, const std::string& complaint,
                   const std::string& outward);
Finding CheckTtl(const bus::UdpmAddress& address, const nlohmann::json& routes, const std::string& outward);
// Sends one message to ourselves, which does not leave the machine.
Finding CheckLoopback(const bus::UdpmAddress& address);
// Gets a buffer the way the drivers do and asks the kernel how large it became.
Finding CheckReceiveBuffer(const std::string& whose, int wanted_bytes);
Finding CheckLidarPort(int port);

// The interface of the first of these routes; empty when there is none.
std::string Device(const nlohmann::json& routes);
std::string GroupText(const bus::UdpmAddress& address);

}  // namespace mapweld::doctor
