// SPDX-License-Identifier: Apache-2.0
// An LCM address that no other process uses: the default group, messages stay on the machine, the port follows the
// process.
#pragma once

#include <unistd.h>

#include <string>

namespace mapweld::bus::test {

inline std::string PrivateUrl() {
  return "udpm://239.255.76.67:" + std::to_string(20000 + ::getpid() % 30000) + "?ttl=0";
}

}  // namespace mapweld::bus::test
