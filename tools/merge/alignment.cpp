// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/alignment.hpp"

#include <cmath>
#include <complex>
#include <stdexcept>

namespace mapweld::merge {

using geom::Pose3;
using geom::Quatd;
using geom::Vec3d;

PlacedMatch Place(const Drive& a, const Drive& b, const Match& match) {
  const Keyframe& keyframe_a = a.keyframes[static_cast<std::size_t>(match.a)];
  const Keyframe& keyframe_b = b.keyframes[static_cast<std::size_t>(match.b)];
  const place::RelativeYaw yaw = place::EstimateRelativeYaw(keyframe_a.place.orientation, keyframe_b.place.orientation);
  return {match, geom::Level(keyframe_a.odom_T_body), geom::Level(keyframe_b.odom_T_body),
          static_cast<double>(yaw.yaw_rad)};
}

Alignment Align(const std::vector<PlacedMatch>& matches, const AlignmentNoise& noise) {
  if (matches.empty()) throw std::runtime_error("alignment needs at least one match");
  const double n = static_cast<double>(matches.size());
  Vec3d center_a = Vec3d::Zero();
  Vec3d center_b = Vec3d::Zero();
  for (const PlacedMatch& m : matches) {
    center_a += m.odom_a_T_level.t / n;
    center_b += m.odom_b_T_level.t / n;
  }
  // Every measurement of the yaw as a complex number: its direction is the yaw, its length the information.
  std::complex<double> sum = 0;
  const double position_weight = 1 / (noise.position_sigma_m * noise.position_sigma_m);
  const double yaw_weight = 1 / (noise.yaw_sigma_rad * noise.yaw_sigma_rad);
  for (const PlacedMatch& m : matches) {
    const Vec3d p_a = m.odom_a_T_level.t - center_a;
    const Vec3d p_b = m.odom_b_T_level.t - center_b;
    sum += 0.5 * position_weight * std::complex<double>(p_a.x(), p_a.y()) *
           std::conj(std::complex<double>(p_b.x(), p_b.y()));
    const double odom_yaw_rad = geom::Yaw(m.odom_a_T_level.q) + m.yaw_rad - geom::Yaw(m.odom_b_T_level.q);
    sum += yaw_weight * std::polar(1.0, odom_yaw_rad);
  }
  Alignment out;
  out.a_T_b.q = Quatd(Eigen::AngleAxisd(std::arg(sum), Vec3d::UnitZ()));
  out.a_T_b.t = center_a - out.a_T_b.q * center_b;
  out.yaw_sigma_rad = std::abs(sum) > 0 ? 1 / std::sqrt(std::abs(sum)) : 1e3;
  double squares = 0;
  for (const PlacedMatch& m : matches) squares += (m.odom_a_T_level.t - out.a_T_b * m.odom_b_T_level.t).squaredNorm();
  out.rms_m = std::sqrt(squares / n);
  return out;
}

}  // namespace mapweld::merge
