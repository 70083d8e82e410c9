// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/lidar_simulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/sim/hash_noise.hpp"

namespace mapweld::sim {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr std::int64_t kTrafficWindow_ns = 100'000'000;  // that long, moving things move in a straight line
constexpr double kRadPerDeg = std::numbers::pi / 180;

// World pose of the lidar over one column: linear between its ends. Over a tenth of a millisecond a vehicle's true
// motion differs from that by nanometres.
struct MovingPose {
  Matrix3f rotation_begin, rotation_change;
  Vector3f position_begin, position_change;
};

MovingPose PoseOver(const VehicleMotion& motion, const geom::Pose3& body_T_lidar, double t_begin, double t_end) {
  const geom::Pose3 a = motion.WorldFromBody(t_begin) * body_T_lidar;
  const geom::Pose3 b = motion.WorldFromBody(t_end) * body_T_lidar;
  const geom::Mat3d rotation_a = a.q.toRotationMatrix();
  const geom::Mat3d change = b.q.toRotationMatrix() - rotation_a;
  return {rotation_a.cast<float>(), change.cast<float>(), a.t.cast<float>(), (b.t - a.t).cast<float>()};
}

}  // namespace

LidarSimulator::LidarSimulator(const RayCaster& caster, const VehicleMotion& motion, const Traffic* traffic,
                               const LidarModel& model, const Weather& weather, std::int64_t start_past_hour_ns,
                               std::uint64_t seed)
    : caster_(caster),
      motion_(motion),
      traffic_(traffic),
      model_(model),
      receiver_(model, weather),
      start_past_hour_ns_(start_past_hour_ns),
      seed_(seed) {
  for (const Beam& beam : model_.beams) {
    elevations_.push_back({std::sin(beam.elevation_deg * kRadPerDeg), std::cos(beam.elevation_deg * kRadPerDeg)});
    const std::uint64_t bits = Hash(seed_, errors_.size(), 0xBEA7);
    // The sensor sends whole steps.
    const double steps = std::round(model_.beam_range_sigma_m * Gaussian(bits) / model_.range_step_m);
    errors_.push_back({steps * model_.range_step_m, model_.beam_elevation_sigma_rad * Gaussian(Mix(bits))});
  }
}

const RayScene* LidarSimulator::SceneOf(std::int64_t window) const {
  if (traffic_ == nullptr) return nullptr;
  if (window != window_ || moving_ == nullptr) {
    window_ = window;
    const double begin = static_cast<double>(window * kTrafficWindow_ns) * 1e-9;
    const Traffic::Moving moving = traffic_->Between(begin, begin + static_cast<double>(kTrafficWindow_ns) * 1e-9);
    moving_ = std::make_unique<RayScene>(moving.begin, moving.end);
  }
  return moving_.get();
}

template <class Visit>
void LidarSimulator::Fire(std::int64_t index, std::uint64_t sample, const Visit& visit) const {
  const std::uint64_t seed = seed_ + (sample << 32U);
  const std::int64_t begin_ns = model_.ColumnStart_ns(index);
  const auto seconds = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-9; };
  const MovingPose pose =
      PoseOver(motion_, model_.body_T_lidar, seconds(begin_ns), seconds(model_.ColumnStart_ns(index + 1)));
  const std::int64_t window = begin_ns / kTrafficWindow_ns;
  const RayScene* moving = SceneOf(window);
  const double column_rad = Azimuth_deg(index) * kRadPerDeg;
  constexpr double kTurn_rad_per_ns = 2 * std::numbers::pi / static_cast<double>(kRevolution_ns);
  RayPacket rays;
  std::array<Vector3f, RayPacket::kRays> nominal;  // where the sensor believes its beams to look
  for (std::size_t first = 0; first < model_.beams.size(); first += RayPacket::kRays) {
    for (std::size_t ray = 0; ray < RayPacket::kRays; ++ray) {
      const Beam& beam = model_.beams[first + ray];
      const auto [sine, cosine] = elevations_[first + ray];
      const double azimuth =
          column_rad + static_cast<double>(beam.fires_ns) * kTurn_rad_per_ns + beam.azimuth_deg * kRadPerDeg;
      const double sin_azimuth = std::sin(azimuth);
      const double cos_azimuth = std::cos(azimuth);
      // Clockwise from forward; ours is x forward, y left.
      const Vector3f along(static_cast<float>(cosine * cos_azimuth), static_cast<float>(-cosine * sin_azimuth),
                           static_cast<float>(sine));
      const Vector3f right(static_cast<float>(-sin_azimuth), static_cast<float>(-cos_azimuth), 0);
      const Vector3f up(static_cast<float>(-sine * cos_azimuth), static_cast<float>(sine * sin_azimuth),
                        static_cast<float>(cosine));
      // A beam is a few centimetres wide, and somewhere in it is what answers.
      const std::uint64_t bits = Hash(seed, static_cast<std::uint64_t>(index), 2 * (first + ray));
      const auto aside = static_cast<float>(model_.divergence_rad * Gaussian(bits));
      const auto above =
          static_cast<float>(model_.divergence_rad * Gaussian(Mix(bits)) + errors_[first + ray].elevation_rad);
      const Vector3f lit = (along + aside * right + above * up).normalized();
      const float share =
          static_cast<float>(static_cast<double>(beam.fires_ns) * 1e3 / static_cast<double>(model_.column_ps));
      const Vector3f direction = pose.rotation_begin * lit + share * (pose.rotation_change * lit);
      nominal[ray] = pose.rotation_begin * along + share * (pose.rotation_change * along);
      const Vector3f origin = pose.position_begin + share * pose.position_change;
      const std::int64_t in_window_ns = begin_ns + beam.fires_ns - window * kTrafficWindow_ns;
      rays.time[ray] = std::min(1.0F, static_cast<float>(in_window_ns) / static_cast<float>(kTrafficWindow_ns));
      rays.origin_x[ray] = origin.x();
      rays.origin_y[ray] = origin.y();
      rays.origin_z[ray] = origin.z();
      rays.direction_x[ray] = direction.x();
      rays.direction_y[ray] = direction.y();
      rays.direction_z[ray] = direction.z();
    }
    caster_.Cast(rays, model_.max_range_m, moving);
    for (std::size_t ray = 0; ray < RayPacket::kRays; ++ray) {
      const std::uint64_t bits = Hash(seed, static_cast<std::uint64_t>(index), 2 * (first + ray) + 1);
      LidarReturn measured =
          rays.distance_m[ray] > 0
              ? receiver_.Detect(rays.surface[ray], rays.patch[ray], static_cast<double>(rays.distance_m[ray]),
                                 static_cast<double>(rays.cos_incidence[ray]), bits)
              : receiver_.DetectAir(static_cast<double>(model_.max_range_m), bits);
      if (measured.distance_m <= 0) continue;
      measured.distance_m += static_cast<float>(errors_[first + ray].range_m);
      visit(first + ray, measured, Vector3f(rays.origin_x[ray], rays.origin_y[ray], rays.origin_z[ray]), nominal[ray]);
    }
  }
}

void LidarSimulator::Column(std::int64_t index, std::vector<LidarReturn>* returns) const {
  returns->assign(model_.beams.size(), {});
  Fire(index, 0, [&](std::size_t beam, const LidarReturn& measured, const Vector3f&, const Vector3f&) {
    (*returns)[beam] = measured;
  });
}

void LidarSimulator::DualColumn(std::int64_t index, std::vector<LidarReturn>* nearer,
                                std::vector<LidarReturn>* farther) const {
  Column(index, nearer);
  *farther = *nearer;
  Fire(index, 1, [&](std::size_t beam, const LidarReturn& measured, const Vector3f&, const Vector3f&) {
    const float first_m = (*nearer)[beam].distance_m;
    const bool alone = first_m <= 0;
    if (alone || measured.distance_m >= first_m + kReturnsApart_m) (*farther)[beam] = measured;
    if (alone || measured.distance_m <= first_m - kReturnsApart_m) (*nearer)[beam] = measured;
  });
}

void LidarSimulator::AppendPoints(std::int64_t index, std::vector<Vector3f>* world_points) const {
  Fire(index, 0, [&](std::size_t, const LidarReturn& measured, const Vector3f& origin, const Vector3f& direction) {
    world_points->push_back(origin + measured.distance_m * direction);
  });
}

}  // namespace mapweld::sim
