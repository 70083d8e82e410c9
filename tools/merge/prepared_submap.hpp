// SPDX-License-Identifier: Apache-2.0
// A submap made ready for registration: its points and its surfels (1 m voxels with the local shape) in vertical
// columns for quick neighbour search, and a bird's-eye image of what stands upright.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tools/merge/drive.hpp"

namespace mapweld::merge {

// Mean of the points in one 1 m voxel with the inverse covariance of the 3 m cube around it, plus the rounding of the
// voxels: stiff across a wall, soft along it.
struct Surfel {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  bool is_structure = false;  // tells one place from another: walls, poles, trees; not the ground
};

// What stands upright, seen from above, in square images around the keyframe, row = x.
struct BevImage {
  static constexpr int kFine = 128;   // cells of 1 m per side
  static constexpr int kCoarse = 64;  // cells of 2 m per side
  static constexpr int kFull = 7;     // value of a tall structure; ground and nothing are 0
  static constexpr std::size_t kStrongest = 900;
  static constexpr std::int8_t kUnseen = -128;
  // Twice the value less twice its mean over the part that was seen. So a structure that falls on seen, empty ground
  // speaks against a pose, and one that falls where nothing was seen says nothing.
  std::vector<std::int8_t> fine_contrast;
  std::vector<std::int8_t> coarse_contrast;
  std::vector<Eigen::Vector2f> strongest;  // m, centres of the fine cells with the highest values
};

class PreparedSubmap {
 public:
  static constexpr int kColumns = 128;      // per side, 1 m each
  static constexpr float kHalfSize_m = 64;  // points further out than this are left out
  static constexpr int kCoverCells = 32;    // per side, 4 m each

  // Cost: about 3 ms for 20 k points. A cloud of any size is valid, an empty one too.
  explicit PreparedSubmap(const SubmapCloud& cloud);

  [[nodiscard]] const std::vector<Eigen::Vector3f>& points() const { return points_; }
  [[nodiscard]] const std::vector<Surfel>& surfels() const { return surfels_; }
  // Points used as the source of a registration: three quarters structure, one quarter ground, in a mixed order so that
  // every n-th of them is an even choice too.
  [[nodiscard]] const std::vector<std::uint32_t>& samples() const { return samples_; }
  // Points that decide whether two submaps show the same.
  [[nodiscard]] const std::vector<std::uint32_t>& structure_samples() const { return structure_samples_; }
  [[nodiscard]] const BevImage& bev() const { return bev_; }

  // Index of the surfel whose mean is nearest to p, within max_distance_m, or -1.
  [[nodiscard]] int NearestSurfel(const Eigen::Vector3f& p, float max_distance_m) const;
  // Is a point closer to p than max_distance_m?
  [[nodiscard]] bool HasPoint(const Eigen::Vector3f& p, float max_distance_m) const;
  // Has the submap seen anything at all around (p.x, p.y), at about 4 m resolution?
  [[nodiscard]] bool Covers(const Eigen::Vector3f& p) const;
  // Corners of the box that holds the middle 90 % of the points along each axis.
  [[nodiscard]] const Eigen::Vector3f& low() const { return low_; }
  [[nodiscard]] const Eigen::Vector3f& high() const { return high_; }
  // Lowest point in each cover cell (NaN: none).
  [[nodiscard]] const std::vector<float>& lowest() const { return lowest_; }

 private:
  void SortIntoColumns(const SubmapCloud& cloud);
  void FindBounds();
  void MakeSurfels();
  void FindShapes();
  void DrawBev();
  [[nodiscard]] std::vector<std::int8_t> Contrast(const std::vector<std::uint8_t>& image, std::size_t size) const;
  void ChooseSamples();

  std::vector<Eigen::Vector3f> points_;      // by column
  std::vector<std::uint32_t> point_begin_;   // of each column; kColumns^2 + 1
  std::vector<Surfel> surfels_;              // by column, then height
  std::vector<std::uint32_t> surfel_begin_;  // of each column; kColumns^2 + 1
  std::vector<std::uint32_t> surfel_of_;     // per point
  std::vector<std::uint32_t> samples_;
  std::vector<std::uint32_t> structure_samples_;
  std::vector<float> lowest_;
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f high_ = Eigen::Vector3f::Zero();
  BevImage bev_;
};

}  // namespace mapweld::merge
