// SPDX-License-Identifier: Apache-2.0
// A spinning LiDAR at 600 rpm on a moving vehicle: every beam leaves at its own moment from where the sensor is then.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/geom/pose3.hpp"
#include "tools/sim/ray_caster.hpp"
#include "tools/sim/receiver.hpp"
#include "tools/sim/traffic.hpp"
#include "tools/sim/vehicle_motion.hpp"

namespace mapweld::sim {

inline constexpr std::int64_t kRevolution_ns = 100'000'000;
inline constexpr float kReturnsApart_m = 1;

class LidarSimulator {
 public:
  // `start_past_hour_ns`: sensor time at t = 0 of the motion. The scan angle is locked to the second: 0, forward, at
  // whole tenths. `traffic` may be null. Refers to its first three arguments. One thread at a time.
  LidarSimulator(const RayCaster& caster, const VehicleMotion& motion, const Traffic* traffic, const LidarModel& model,
                 const Weather& weather, std::int64_t start_past_hour_ns, std::uint64_t seed);

  [[nodiscard]] const LidarModel& model() const { return model_; }
  [[nodiscard]] std::int64_t ColumnsPerRevolution() const { return kRevolution_ns * 1000 / model_.column_ps; }

  // Column `index` begins model().ColumnStart_ns(index) after the start; one return per beam. Depends on nothing but
  // the index.
  void Column(std::int64_t index, std::vector<LidarReturn>* returns) const;
  // As a sensor in dual return mode sees it: the light of a beam on an edge comes back from two surfaces, at least
  // kReturnsApart_m from each other. `nearer` are the same as `farther` where it comes back from one. Twice the work.
  void DualColumn(std::int64_t index, std::vector<LidarReturn>* nearer, std::vector<LidarReturn>* farther) const;
  // The returns of the same column as points: what a perfect odometry would make of it.
  void AppendPoints(std::int64_t index, std::vector<Eigen::Vector3f>* world_points) const;
  // Sensor time of a column's first beam, and where the sensor looks then: degrees from forward, clockwise.
  [[nodiscard]] std::int64_t PastHour_ns(std::int64_t index) const {
    return start_past_hour_ns_ + model_.ColumnStart_ns(index);
  }
  [[nodiscard]] double Azimuth_deg(std::int64_t index) const {
    return 360.0 * static_cast<double>(PastHour_ns(index) % kRevolution_ns) / static_cast<double>(kRevolution_ns);
  }

 private:
  // Fires all beams of one column: visit(beam, return, origin, direction) for those that came back. Another `sample`
  // looks in another direction within each beam, with other noise.
  template <class Visit>
  void Fire(std::int64_t index, std::uint64_t sample, const Visit& visit) const;
  // What moves in one window of time; kept until another is asked for.
  const RayScene* SceneOf(std::int64_t window) const;

  const RayCaster& caster_;
  const VehicleMotion& motion_;
  const Traffic* traffic_;
  LidarModel model_;
  Receiver receiver_;
  std::int64_t start_past_hour_ns_;
  std::uint64_t seed_;
  struct Elevation {
    double sine;
    double cosine;
  };
  std::vector<Elevation> elevations_;
  struct BeamError {
    double range_m;
    double elevation_rad;
  };
  std::vector<BeamError> errors_;
  mutable std::int64_t window_ = -1;
  mutable std::unique_ptr<RayScene> moving_;
};

}  // namespace mapweld::sim
