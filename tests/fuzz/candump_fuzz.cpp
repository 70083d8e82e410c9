// SPDX-License-Identifier: Apache-2.0
// The input is a candump log.
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <string_view>

#include "drivers/can/candump_port.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace mapweld::fuzz {

std::vector<Bytes> Seeds() {
  std::vector<Bytes> out;
  for (const std::string_view log :
       {"(1436509052.249713) can0 034#00FF01020304\n(1436509052.250000) can0 005#00000001\n",
        "(1.5) can0 123#R4\n(1.6) can0 00000123#11\n(1.7) can0 20000040#0000000000000000\n(1.8) can0 123##0AA\n\nx\n",
        "(1.123456789) can1 7FF#0011223344556677 T"}) {
    out.emplace_back(log.begin(), log.end());
  }
  return out;
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using mapweld::Status;
  static mapweld::can::CandumpPort port;
  static const int fd = ::memfd_create("log", 0);  // one for all inputs: making files is what costs
  FUZZ_REQUIRE(::ftruncate(fd, 0) == 0 && ::pwrite(fd, data, size, 0) == static_cast<ssize_t>(size));
  FUZZ_REQUIRE(::lseek(fd, 0, SEEK_SET) == 0);
  FUZZ_REQUIRE(port.Adopt(::dup(fd), size % 2 == 0 ? "" : "can0") == Status::kOk);
  std::array<mapweld::can::CanFrame, 3> frames;
  std::size_t n = 0;
  std::size_t total = 0;
  while (port.Receive(frames, &n) == Status::kOk) {
    FUZZ_REQUIRE(n > 0);
    total += n;
    for (std::size_t i = 0; i < n; ++i) {
      FUZZ_REQUIRE(frames[i].dlc <= 8 && frames[i].receive.ns >= 0 && frames[i].id <= 0x1FFFFFFF);
    }
  }
  FUZZ_REQUIRE(total <= size);
  port.Close();
  return 0;
}
