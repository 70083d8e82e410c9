// SPDX-License-Identifier: Apache-2.0
// The merged cloud from above: how much is there makes a pixel opaque, how high it is above the ground gives its
// colour.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/geom/pose3.hpp"
#include "tools/report/merged_map.hpp"
#include "tools/report/png_image.hpp"

namespace mapweld::report {

// The part of the merged frame that a drawing shows; x to the right, y up. Units of a drawing are CSS pixels.
struct MapView {
  double left_m = 0;
  double top_m = 0;
  double m_per_unit = 1;
  double width = 1;
  double height = 1;

  [[nodiscard]] Eigen::Vector2d ToDrawing(const geom::Vec3d& p_merged) const {
    return {(p_merged.x() - left_m) / m_per_unit, (top_m - p_merged.y()) / m_per_unit};
  }
};

// Fits a drawing of at most `most_width` x `most_height` around the trajectories and the bulk of the points: a few
// stray points far away do not shrink everything else.
MapView FitView(const std::vector<MapPoint>& points, const std::vector<std::vector<geom::Pose3>>& trajectories,
                double most_width, double most_height);

// Transparent where nothing is. Drawn for dark ground; on light ground the page inverts it. The ground is the low
// points of each 8 m square, so that hills do not tint the town. Cost: one pass over the points, two over the pixels.
PaletteImage RenderMap(const std::vector<MapPoint>& points, const MapView& view);

}  // namespace mapweld::report
