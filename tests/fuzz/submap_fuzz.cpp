// SPDX-License-Identifier: Apache-2.0
// The input is an encoded submap. It is decoded as it is, and once more with the checksum at its end made right.
#include <cmath>
#include <memory>

#include "core/base/byte_io.hpp"
#include "core/base/crc32.hpp"
#include "core/submap/submap_codec.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/support/sort_points.hpp"

namespace mapweld::fuzz {

std::vector<Bytes> Seeds() {
  auto submap = std::make_unique<submap::Submap>();
  auto encoder = std::make_unique<submap::SubmapEncoder>();
  submap->keyframe = 5;
  submap->t = {123'456'789};
  std::vector<Bytes> out;
  for (const int width : {0, 1, 5}) {
    submap->points.clear();
    for (int z = 0; z < width; ++z) {
      for (int y = 0; y < width; ++y) {
        for (int x = 0; x < width; ++x) {
          FUZZ_REQUIRE(submap->points.TryPush({.x = static_cast<float>(x - 2) * 2.0F + 0.1F,
                                               .y = static_cast<float>(y - 2) * 0.5F + 0.2F,
                                               .z = static_cast<float>(z) * 0.5F + 0.3F,
                                               .count = static_cast<std::uint16_t>(1 + x)}) == Status::kOk);
        }
      }
    }
    test::SortPoints(submap.get());
    Bytes bytes(8192);
    const Result<std::size_t> n = encoder->Encode(*submap, bytes);
    FUZZ_REQUIRE(n.ok());
    bytes.resize(n.value());
    out.push_back(bytes);
  }
  return out;
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld;
  static submap::Submap submap;
  fuzz::Bytes bytes(data, data + size);
  for (int round = 0; round < 2; ++round) {
    if (submap::DecodeSubmap(bytes, &submap) == Status::kOk) {
      FUZZ_REQUIRE(submap.points.size() <= kCap.submap_points);
      for (const submap::SubmapPoint& point : submap.points) {
        FUZZ_REQUIRE(std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z));
      }
    }
    if (bytes.size() < 4) break;
    const auto content = std::span(bytes).first(bytes.size() - 4);
    ByteWriter(std::span(bytes).last(4)).Little(Crc32(content));
  }
  return 0;
}
