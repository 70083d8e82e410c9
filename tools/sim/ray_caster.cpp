// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/ray_caster.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

namespace mapweld::sim {

struct RayCaster::Scene {
  RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
  RTCScene scene = device != nullptr ? rtcNewScene(device) : nullptr;
  ~Scene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

namespace {

void Attach(RTCDevice device, RTCScene scene, const Mesh& mesh, unsigned id) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(Eigen::Vector3f), mesh.vertices.size());
  void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(Mesh::Triangle), mesh.triangles.size());
  if (vertices == nullptr || triangles == nullptr) {
    rtcReleaseGeometry(geometry);
    throw std::runtime_error("not enough memory for the town's triangles; choose a smaller scenario");
  }
  std::memcpy(vertices, mesh.vertices.data(), mesh.vertices.size() * sizeof(Eigen::Vector3f));
  std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * sizeof(Mesh::Triangle));
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

}  // namespace

RayCaster::RayCaster(const TownMesh& mesh) : scene_(std::make_unique<Scene>()) {
  if (scene_->scene == nullptr) throw std::runtime_error("the ray caster Embree does not start on this machine");
  // Robust: rays never slip through the seam between two triangles.
  rtcSetSceneFlags(scene_->scene, RTC_SCENE_FLAG_ROBUST);
  for (unsigned i = 0; i < kSurfaces; ++i) {
    if (!mesh[i].triangles.empty()) Attach(scene_->device, scene_->scene, mesh[i], i);
  }
  rtcCommitScene(scene_->scene);
  if (const RTCError error = rtcGetDeviceError(scene_->device); error != RTC_ERROR_NONE) {
    throw std::runtime_error(
        fmt::format("the ray caster Embree failed to build the scene (error {})", static_cast<int>(error)));
  }
}

RayCaster::~RayCaster() = default;

void RayCaster::Cast(RayPacket& rays, float max_range_m) const {
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
    query.ray.time[i] = 0;
    query.ray.mask[i] = ~0U;
    query.ray.id[i] = 0;
    query.ray.flags[i] = 0;
    query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid.data(), scene_->scene, &context, &query);
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
