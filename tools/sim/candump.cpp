// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/candump.hpp"

#include <fmt/format.h>

#include <iterator>

namespace mapweld::sim {

std::string CandumpLine(std::int64_t stamp_ns, const CanFrame& frame) {
  std::string line;
  fmt::format_to(std::back_inserter(line), "({:010}.{:06}) can0 {:03X}#", stamp_ns / 1'000'000'000,
                 stamp_ns % 1'000'000'000 / 1000, frame.id);
  for (std::size_t i = 0; i < frame.length; ++i) fmt::format_to(std::back_inserter(line), "{:02X}", frame.data[i]);
  line += '\n';
  return line;
}

}  // namespace mapweld::sim
