// SPDX-License-Identifier: Apache-2.0
// The input is a city model as a CityJSON file.
#include <exception>
#include <string_view>

#include "tests/fuzz/fuzz.hpp"
#include "tools/sim/cityjson_file.hpp"

namespace mapweld::fuzz {

std::vector<Bytes> Seeds() {
  return TextSeeds(
      {R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.01,0.01,0.01],"translate":[8e4,4e5,-1]},)"
       R"("CityObjects":{"a":{"type":"Building","geometry":[{"type":"Solid","lod":"1.2","boundaries":)"
       R"([[[[0,1,2],[3,4,5]],[[0,3,4]]]],"semantics":{"surfaces":[{"type":"GroundSurface"}],"values":[[0,null]]}}]},)"
       R"("b":{"type":"Road","attributes":{"function":"rijbaan"},"geometry":[{"type":"MultiSurface","lod":1,)"
       R"("boundaries":[[[0,1,2]]]}]}},"vertices":[[0,0,0],[900,0,0],[900,800,0],[0,0,9],[1,0,9],[1,1,9]]})",
       R"({"type":"CityJSON","version":"1.0","CityObjects":{},"vertices":[[4.5,52.1,0],[4.6,52.2,1e300]]})"});
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld;
  const fuzz::Bytes bytes(data, data + size);  // of its own size, so that the address sanitizer sees its end
  try {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (const sim::CityObject& object : sim::ParseCityJson(text, "input")) {
      FUZZ_REQUIRE(!object.surfaces.empty());
      for (const sim::CitySurface& surface : object.surfaces) {
        FUZZ_REQUIRE(!surface.rings.empty());
        for (const sim::Ring3& ring : surface.rings) {
          FUZZ_REQUIRE(ring.size() >= 3);
          for (const Eigen::Vector3d& p : ring) FUZZ_REQUIRE(p.allFinite());
        }
      }
    }
  } catch (const std::exception& error) {
    FUZZ_REQUIRE(std::string_view(error.what()).starts_with("input:"));
  }
  return 0;
}
