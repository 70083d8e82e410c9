// SPDX-License-Identifier: Apache-2.0
// The flat east-north frame in which a town is built: metres from an origin in degrees, x east, y north. Good to
// centimetres over the few kilometres of one scenario.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace mapweld::sim {

struct GeoPoint {
  double lat_deg = 0;
  double lon_deg = 0;
};

class LocalFrame {
 public:
  // Radii of curvature of the WGS84 ellipsoid at the origin.
  explicit LocalFrame(GeoPoint origin) : origin_(origin) {
    constexpr double kSemiMajor_m = 6378137.0;
    constexpr double kEccentricity2 = 6.69437999014e-3;
    const double lat = origin.lat_deg * kRadPerDeg;
    const double w2 = 1 - kEccentricity2 * std::sin(lat) * std::sin(lat);
    east_m_per_deg_ = kSemiMajor_m / std::sqrt(w2) * std::cos(lat) * kRadPerDeg;
    north_m_per_deg_ = kSemiMajor_m * (1 - kEccentricity2) / (w2 * std::sqrt(w2)) * kRadPerDeg;
  }
  [[nodiscard]] Eigen::Vector2d ToLocal(GeoPoint p) const {
    return {(p.lon_deg - origin_.lon_deg) * east_m_per_deg_, (p.lat_deg - origin_.lat_deg) * north_m_per_deg_};
  }
  [[nodiscard]] GeoPoint ToGeo(const Eigen::Vector2d& p) const {
    return {origin_.lat_deg + p.y() / north_m_per_deg_, origin_.lon_deg + p.x() / east_m_per_deg_};
  }
  [[nodiscard]] GeoPoint origin() const { return origin_; }

 private:
  static constexpr double kRadPerDeg = std::numbers::pi / 180;
  GeoPoint origin_;
  double east_m_per_deg_ = 0;
  double north_m_per_deg_ = 0;
};

}  // namespace mapweld::sim
