// SPDX-License-Identifier: Apache-2.0
// Encoded submaps from the pieces in which they travel: in any order, any number of times.
#pragma once

#include <cstdint>
#include <map>
#include <mapweldlcm/submap_chunk_t.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "tools/serve/drive_id.hpp"

namespace mapweld::serve {

class SubmapAssembly {
 public:
  // The whole encoded submap, when this piece was the last that it lacked.
  std::optional<std::vector<std::uint8_t>> Add(const mapweldlcm::submap_chunk_t& piece);
  [[nodiscard]] std::uint64_t repeated() const { return repeated_; }

 private:
  struct Partial {
    std::vector<std::uint8_t> bytes;
    std::map<std::int32_t, std::int32_t> pieces;  // offset -> length
  };
  std::map<std::pair<DriveId, std::int32_t>, Partial> partial_;
  std::uint64_t repeated_ = 0;
};

}  // namespace mapweld::serve
