// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/odometry_map.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "tools/odometry/odometry_report.hpp"
#include "tools/odometry/submap_agreement.hpp"
#include "tools/report/map_image.hpp"

namespace mapweld::odometry {
namespace {

using Color = std::array<std::uint8_t, 4>;
constexpr Color kGround{18, 22, 30, 255};
constexpr Color kWay{255, 122, 61, 255};

Color OnGround(const Color& color) {
  Color blended = kGround;
  for (std::size_t i = 0; i < 3; ++i) {
    blended[i] = static_cast<std::uint8_t>((color[i] * color[3] + kGround[i] * (255 - color[3])) / 255);
  }
  return blended;
}

}  // namespace

std::string MapPng(const OdometryRun& run) {
  constexpr double kMostUnits = 1200;  // two pixels each
  const std::vector<io::StampedPose> way = Trajectory(run);
  std::vector<report::MapPoint> points;
  for (const PlacedSubmap& submap : PlaceSubmaps(run, way)) {
    for (const Eigen::Vector3f& p : submap.points) {
      points.push_back({(submap.world_T_level * p.cast<double>()).cast<float>(), 0});
    }
  }
  if (points.empty()) throw std::runtime_error("the drive gave no submap to draw; is it shorter than 50 m?");
  std::vector<geom::Pose3> poses;
  for (const io::StampedPose& stamped : way) poses.push_back(stamped.world_T_body);

  const report::MapView view = report::FitView(points, {poses}, kMostUnits, kMostUnits);
  report::PaletteImage image = report::RenderMap(points, view);
  for (Color& color : image.palette) color = OnGround(color);
  const auto way_color = static_cast<std::uint8_t>(image.palette.size());
  image.palette.push_back(kWay);
  for (const geom::Pose3& pose : poses) {
    const Eigen::Vector2d at = view.ToDrawing(pose.t);
    const auto column = static_cast<int>(at.x() * image.width / view.width);
    const auto row = static_cast<int>(at.y() * image.height / view.height);
    if (column < 0 || row < 0 || column >= image.width || row >= image.height) continue;
    image.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                 static_cast<std::size_t>(column)] = way_color;
  }
  return report::EncodePng(image);
}

}  // namespace mapweld::odometry
