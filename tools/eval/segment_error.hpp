// SPDX-License-Identifier: Apache-2.0
// Drift over segments of fixed length, as the KITTI odometry benchmark scores it (Geiger, Lenz, Urtasun, "Are we ready
// for autonomous driving?", CVPR 2012, section 3): segments of 100, 200, ... 800 m, one start a second. Recordings too
// short for a length leave it out.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/io/tum.hpp"

namespace mapweld::eval {

struct SegmentError {
  std::size_t segments = 0;
  double translation_percent = 0;  // mean over all segments of |error| / length
  double rotation_deg_per_m = 0;
};

// Poses of truth and estimate at the same places in the lists.
SegmentError SegmentDrift(const std::vector<io::StampedPose>& truth, const std::vector<io::StampedPose>& estimate);

// Relative pose error (Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS 2012), over 10 m of
// true path instead of a fixed time, so that standing still does not count: root mean squares, one start a pose.
struct StepError {
  std::size_t steps = 0;
  double translation_m = 0;
  double rotation_deg = 0;
};
StepError RelativePoseError(const std::vector<io::StampedPose>& truth, const std::vector<io::StampedPose>& estimate);

// Angle between the estimated and the true direction of gravity in the body frame, degrees, one per pose.
std::vector<double> GravityErrorsDeg(const std::vector<io::StampedPose>& truth,
                                     const std::vector<io::StampedPose>& estimate);

}  // namespace mapweld::eval
