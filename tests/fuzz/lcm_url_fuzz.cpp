// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "drivers/bus/lcm_url.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace mapweld::fuzz {

std::vector<Bytes> Seeds() {
  std::vector<Bytes> out;
  for (const std::string_view url :
       {"udpm://", "udpm://239.255.76.67:7667?ttl=0", "udpm://:7667?recv_buf_size=4000000&ttl=1"}) {
    out.emplace_back(url.begin(), url.end());
  }
  return out;
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mapweld::bus::UdpmAddress address;
  const std::string_view url(reinterpret_cast<const char*>(data), size);
  if (mapweld::bus::ParseLcmUrl(url, &address) == mapweld::Status::kOk) {
    FUZZ_REQUIRE((address.group_ipv4 >> 28U) == 0xE);
    FUZZ_REQUIRE(address.port != 0 && address.receive_buffer_bytes != 0);
  }
  return 0;
}
