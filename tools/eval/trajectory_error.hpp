// SPDX-License-Identifier: Apache-2.0
// Absolute trajectory error of one or several vehicles against the truth.
//
// All vehicles of a group are aligned to the truth by one single rigid transform: vehicles that are each perfect but
// wrongly placed to one another score badly, which is what a merge is about. The error of each vehicle aligned on its
// own is given beside it; the difference is the error of the merge.
// Alignment: Umeyama, "Least-squares estimation of transformation parameters between two point patterns", 1991, without
// scale. Agrees with `evo_ape tum truth estimate -a` for one vehicle.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "core/geom/pose3.hpp"
#include "tools/eval/segment_error.hpp"
#include "tools/io/tum.hpp"

namespace mapweld::eval {

struct ErrorStatistics {
  std::size_t count = 0;
  double rmse_m = 0;
  double mean_m = 0;
  double median_m = 0;
  double max_m = 0;
};

// Of distances in metres; all zero for none.
ErrorStatistics Statistics(std::vector<double> errors_m);

struct Vehicle {
  std::string name;
  std::vector<io::StampedPose> truth;     // in order of time
  std::vector<io::StampedPose> estimate;  // in order of time
};

struct VehicleError {
  std::string name;
  ErrorStatistics together;  // after the common alignment
  ErrorStatistics alone;     // after an alignment of its own
  // The motion alone, whatever the alignment. Of nothing (no steps, no segments) when truth or estimate has positions
  // only.
  StepError step;
  SegmentError drift;
  std::size_t unmatched = 0;     // estimated poses at times without truth
  std::vector<double> errors_m;  // of the matched poses in order, after the common alignment
};

struct GroupError {
  ErrorStatistics all;  // over all poses of all vehicles
  std::vector<VehicleError> vehicles;
  geom::Pose3 truth_T_estimate;
};

// Throws when a vehicle has no pose with truth at its time. Cost: linear in the poses.
GroupError EvaluateGroup(const std::vector<Vehicle>& group);

// The truth at time t, interpolated. False outside the truth (10 ms beyond its ends is still inside) and in gaps of
// more than one second.
bool TruthAt(const std::vector<io::StampedPose>& truth, TimeNs t, geom::Pose3* world_T_body);

// The rigid a_T_b with the smallest sum of |a_i - a_T_b * b_i|^2. Identity for no points; a shift for one. Points on
// one line leave the rotation about it open: the smallest one that fits is not looked for, any is as good.
geom::Pose3 AlignRigidly(const std::vector<geom::Vec3d>& a, const std::vector<geom::Vec3d>& b);

}  // namespace mapweld::eval
