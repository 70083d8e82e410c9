// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/ray_caster.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "tools/sim/hash_noise.hpp"

namespace mapweld::sim {

namespace {

// One for the process: a scene per tenth of a second of traffic must be cheap.
RTCDevice Device() {
  static const RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
  return device;
}

}  // namespace

struct RayScene::Tree {
  RTCScene scene = Device() != nullptr ? rtcNewScene(Device()) : nullptr;
  ~Tree() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }
};

namespace {

// What the filter below finds behind Embree's own context.
struct CastContext {
  RTCIntersectContext embree;
  std::uint64_t foliage_seed;
  double foliage_density;
};

// Lets beams pass where this drive's trees have no leaves.
void PassBareBranches(const RTCFilterFunctionNArguments* hits) {
  const auto* context = reinterpret_cast<const CastContext*>(hits->context);
  if (context->foliage_density >= 1) return;
  for (unsigned i = 0; i < hits->N; ++i) {
    if (hits->valid[i] == 0) continue;
    const unsigned patch = RTCHitN_primID(hits->hit, hits->N, i) / 2;
    if (Uniform(Mix(context->foliage_seed + patch * 0x9E3779B97F4A7C15ULL)) >= context->foliage_density)
      hits->valid[i] = 0;
  }
}

void CopyVertices(RTCGeometry geometry, unsigned step, const Mesh& mesh) {
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3,
                                           sizeof(Eigen::Vector3f), mesh.vertices.size());
  if (vertices == nullptr) throw std::runtime_error("not enough memory for the town; choose a smaller scenario");
  std::memcpy(vertices, mesh.vertices.data(), mesh.vertices.size() * sizeof(Eigen::Vector3f));
}

// `end` may be null: nothing moves.
void Attach(RTCScene scene, const Mesh& mesh, const Mesh* end, unsigned id) {
  const std::unique_ptr<RTCGeometryTy, decltype(&rtcReleaseGeometry)> owner(
      rtcNewGeometry(Device(), RTC_GEOMETRY_TYPE_TRIANGLE), rtcReleaseGeometry);
  RTCGeometry geometry = owner.get();
  if (end != nullptr) rtcSetGeometryTimeStepCount(geometry, 2);
  CopyVertices(geometry, 0, mesh);
  if (end != nullptr) CopyVertices(geometry, 1, *end);
  void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(Mesh::Triangle), mesh.triangles.size());
  if (triangles == nullptr) throw std::runtime_error("not enough memory for the town; choose a smaller scenario");
  std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * sizeof(Mesh::Triangle));
  if (id == static_cast<unsigned>(Surface::kFoliage)) rtcSetGeometryIntersectFilterFunction(geometry, PassBareBranches);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
}

}  // namespace

void RayScene::Build(const TownMesh& mesh, const TownMesh* end) {
  if (tree_->scene == nullptr) throw std::runtime_error("the ray caster Embree does not start on this machine");
  // Robust: rays never slip through the seam between two triangles.
  rtcSetSceneFlags(tree_->scene, RTC_SCENE_FLAG_ROBUST);
  for (unsigned i = 0; i < kSurfaces; ++i) {
    if (!mesh[i].triangles.empty()) Attach(tree_->scene, mesh[i], end != nullptr ? &(*end)[i] : nullptr, i);
  }
  rtcCommitScene(tree_->scene);
  if (const RTCError error = rtcGetDeviceError(Device()); error != RTC_ERROR_NONE) {
    throw std::runtime_error(
        fmt::format("the ray caster Embree failed to build the scene (error {})", static_cast<int>(error)));
  }
}

RayScene::RayScene(const TownMesh& mesh) : tree_(std::make_unique<Tree>()) {
  Build(mesh, nullptr);
}

RayScene::RayScene(const TownMesh& begin, const TownMesh& end) : tree_(std::make_unique<Tree>()) {
  Build(begin, &end);
}

RayScene::~RayScene() = default;

void RayCaster::Cast(RayPacket& rays, float max_range_m, const RayScene* moving) const {
  alignas(64) RTCRayHit16 query;
  alignas(64) std::array<int, RayPacket::kRays> valid;
  valid.fill(-1);
  for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
    query.ray.org_x[i] = rays.origin_x[i];
    query.ray.org_y[i] = rays.origin_y[i];
    query.ray.org_z[i] = rays.origin_z[i];
    query.ray.dir_x[i] = rays.direction_x[i];
    query.ray.dir_y[i] = rays.direction_y[i];
    query.ray.dir_z[i] = rays.direction_z[i];
    query.ray.tnear[i] = 0;
    query.ray.tfar[i] = max_range_m;
    query.ray.time[i] = rays.time[i];
    query.ray.mask[i] = ~0U;
    query.ray.id[i] = 0;
    query.ray.flags[i] = 0;
    query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  CastContext context{{}, foliage_.seed, foliage_.density};
  rtcInitIntersectContext(&context.embree);
  context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  // A later layer replaces a hit only where it is nearer.
  for (const auto& layer : layers_) rtcIntersect16(valid.data(), layer->tree_->scene, &context.embree, &query);
  if (moving != nullptr) rtcIntersect16(valid.data(), moving->tree_->scene, &context.embree, &query);
  for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
    if (query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) {
      rays.distance_m[i] = 0;
      continue;
    }
    const float nx = query.hit.Ng_x[i];
    const float ny = query.hit.Ng_y[i];
    const float nz = query.hit.Ng_z[i];
    const float length = std::sqrt(nx * nx + ny * ny + nz * nz);
    const float dot = nx * rays.direction_x[i] + ny * rays.direction_y[i] + nz * rays.direction_z[i];
    rays.distance_m[i] = query.ray.tfar[i];
    rays.cos_incidence[i] = length > 0 ? std::abs(dot) / length : 0;
    rays.patch[i] = query.hit.primID[i] / 2;
    rays.surface[i] = static_cast<Surface>(query.hit.geomID[i]);
  }
}

}  // namespace mapweld::sim
