// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/cityjson_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace mapweld::sim {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

constexpr double kFarthest_m = 200'000;  // from the middle

// How many lists lie around one surface, or -1 for what has none.
int SurfaceDepth(const std::string& type) {
  if (type == "MultiSurface" || type == "CompositeSurface") return 1;
  if (type == "Solid") return 2;
  if (type == "MultiSolid" || type == "CompositeSolid") return 3;
  return -1;
}

Vector3d ReadTriple(const json& triple) {
  if (!triple.is_array() || triple.size() != 3) throw std::runtime_error("a vertex is no list of three numbers");
  const Vector3d p(triple[0].get<double>(), triple[1].get<double>(), triple[2].get<double>());
  if (!p.allFinite()) throw std::runtime_error("a coordinate is not finite");
  return p;
}

std::vector<Vector3d> ReadVertices(const json& document) {
  Vector3d scale = Vector3d::Ones();
  Vector3d translate = Vector3d::Zero();
  if (document.contains("transform")) {
    scale = ReadTriple(document["transform"].at("scale"));
    translate = ReadTriple(document["transform"].at("translate"));
  }
  std::vector<Vector3d> vertices;
  for (const json& triple : document.at("vertices")) {
    vertices.emplace_back(ReadTriple(triple).cwiseProduct(scale) + translate);
  }
  if (vertices.empty()) return vertices;
  Vector3d low = vertices.front();
  Vector3d high = low;
  for (const Vector3d& p : vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vector3d extent = high - low;
  if (extent.head<2>().maxCoeff() < 2 && low.head<2>().cwiseAbs().maxCoeff() <= 360) {
    throw std::runtime_error("its coordinates look like degrees; reproject it to metres");
  }
  const Vector3d middle((low.x() + high.x()) / 2, (low.y() + high.y()) / 2, 0);
  for (Vector3d& p : vertices) {
    p -= middle;
    if (!(p.cwiseAbs().maxCoeff() <= kFarthest_m)) {
      throw std::runtime_error(fmt::format("its vertices reach over more than {:.0f} km", 2e-3 * kFarthest_m));
    }
  }
  return vertices;
}

class GeometryReader {
 public:
  GeometryReader(const std::vector<Vector3d>& vertices, std::vector<CitySurface>* surfaces)
      : vertices_(vertices), surfaces_(surfaces) {}

  void Read(const json& geometry) {
    const int depth = SurfaceDepth(geometry.at("type").get<std::string>());
    const json* kinds = nullptr;
    const json* values = nullptr;
    if (geometry.contains("semantics") && geometry["semantics"].is_object()) {
      kinds = &geometry["semantics"].at("surfaces");
      values = &geometry["semantics"].at("values");
    }
    AddSurfaces(geometry.at("boundaries"), kinds, values, depth);
  }

 private:
  // `values` are nested like the boundaries and name one of `kinds` for each surface; a null, or what is missing,
  // stands for a surface or a whole shell without semantics.
  void AddSurfaces(const json& boundaries, const json* kinds, const json* values, int depth) {
    if (!boundaries.is_array()) throw std::runtime_error("its boundaries are not nested as its type wants");
    for (std::size_t i = 0; i < boundaries.size(); ++i) {
      const json* value = values != nullptr && values->is_array() && i < values->size() ? &(*values)[i] : nullptr;
      if (depth > 1) {
        AddSurfaces(boundaries[i], kinds, value, depth - 1);
        continue;
      }
      CitySurface surface = ReadSurface(boundaries[i]);
      if (surface.rings.empty()) continue;
      if (value != nullptr && value->is_number_unsigned()) {
        surface.ground = kinds->at(value->get<std::size_t>()).value("type", "") == "GroundSurface";
      }
      surfaces_->push_back(std::move(surface));
    }
  }

  // Without rings when its outer one has no area.
  [[nodiscard]] CitySurface ReadSurface(const json& rings) const {
    CitySurface surface;
    if (!rings.is_array()) throw std::runtime_error("its boundaries are not nested as its type wants");
    for (const json& indices : rings) {
      Ring3 ring;
      if (!indices.is_array()) throw std::runtime_error("its boundaries are not nested as its type wants");
      for (const json& index : indices) {
        const auto i = index.is_number_unsigned() ? index.get<std::size_t>() : vertices_.size();
        if (i >= vertices_.size()) {
          throw std::runtime_error(fmt::format("it refers to vertex {} of {}",
                                               index.is_number() ? index.dump() : index.type_name(), vertices_.size()));
        }
        ring.push_back(vertices_[i]);
      }
      if (ring.size() < 3 && surface.rings.empty()) return surface;
      if (ring.size() >= 3) surface.rings.push_back(std::move(ring));
    }
    return surface;
  }

  const std::vector<Vector3d>& vertices_;
  std::vector<CitySurface>* surfaces_;
};

// "2.2" in version 1.1 and later, a number before.
double LodOf(const json& geometry) {
  const auto lod = geometry.find("lod");
  if (lod == geometry.end()) return 0;
  return lod->is_string() ? std::strtod(lod->get<std::string>().c_str(), nullptr) : lod->get<double>();
}

CityObject ReadObject(const std::string& id, const json& object, const std::vector<Vector3d>& vertices) {
  CityObject out;
  out.id = id;
  out.type = object.at("type").get<std::string>();
  if (object.contains("attributes") && object["attributes"].contains("function") &&
      object["attributes"]["function"].is_string()) {
    out.function = object["attributes"]["function"].get<std::string>();
  }
  const json* best = nullptr;
  if (object.contains("geometry")) {
    for (const json& geometry : object["geometry"]) {
      if (SurfaceDepth(geometry.at("type").get<std::string>()) < 0) continue;
      if (best == nullptr || LodOf(geometry) > LodOf(*best)) best = &geometry;
    }
  }
  if (best == nullptr) return out;
  out.lod = LodOf(*best);
  GeometryReader(vertices, &out.surfaces).Read(*best);
  return out;
}

std::vector<CityObject> ReadObjects(const json& document) {
  if (!document.is_object() || document.value("type", "") != "CityJSON") {
    throw std::runtime_error("no CityJSON: its type is another");
  }
  const std::string version = document.at("version").get<std::string>();
  if (!version.starts_with("1.") && !version.starts_with("2.")) {
    throw std::runtime_error(fmt::format("CityJSON version {} is not known; 1.0 to 2.0 are", version));
  }
  const std::vector<Vector3d> vertices = ReadVertices(document);
  std::vector<CityObject> objects;
  for (const auto& [id, object] : document.at("CityObjects").items()) {
    try {
      CityObject read = ReadObject(id, object, vertices);
      if (!read.surfaces.empty()) objects.push_back(std::move(read));
    } catch (const std::exception& e) {
      throw std::runtime_error(fmt::format("object '{}': {}", id, e.what()));
    }
  }
  return objects;
}

}  // namespace

std::vector<CityObject> ParseCityJson(std::string_view text, const std::string& name) {
  try {
    return ReadObjects(json::parse(text));
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("{}: {}", name, e.what()));
  }
}

}  // namespace mapweld::sim
