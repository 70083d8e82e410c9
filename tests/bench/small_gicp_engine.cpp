// SPDX-License-Identifier: Apache-2.0
// small_gicp (https://github.com/koide3/small_gicp): GICP from scan to scan as in its own odometry benchmark (0.25 m,
// 20 neighbours, 1 m), one thread. The last motion is the first guess, which its benchmark leaves out.
#include <small_gicp/ann/kdtree.hpp>
#include <small_gicp/factors/gicp_factor.hpp>
#include <small_gicp/points/point_cloud.hpp>
#include <small_gicp/registration/reduction.hpp>
#include <small_gicp/registration/registration.hpp>
#include <small_gicp/util/downsampling.hpp>
#include <small_gicp/util/normal_estimation.hpp>

#include "tests/bench/odometry_engine.hpp"

namespace mapweld::bench {
namespace {

class SmallGicp final : public OdometryEngine {
 public:
  [[nodiscard]] std::string name() const override { return "small_gicp GICP"; }
  geom::Pose3 Register(const std::vector<Eigen::Vector3f>& points) override {
    const auto cloud = small_gicp::voxelgrid_sampling(small_gicp::PointCloud(points), 0.25);
    const auto tree = std::make_shared<small_gicp::KdTree<small_gicp::PointCloud>>(cloud);
    small_gicp::estimate_covariances(*cloud, *tree, 20);
    if (last_ != nullptr) {
      small_gicp::Registration<small_gicp::GICPFactor, small_gicp::SerialReduction> registration;
      registration.rejector.max_dist_sq = 1.0;
      step_ = registration.align(*last_, *cloud, *last_tree_, step_).T_target_source;
      world_T_lidar_ = world_T_lidar_ * step_;
    }
    last_ = cloud;
    last_tree_ = tree;
    return {world_T_lidar_.translation(), geom::Quatd(world_T_lidar_.rotation())};
  }

 private:
  small_gicp::PointCloud::Ptr last_;
  small_gicp::KdTree<small_gicp::PointCloud>::Ptr last_tree_;
  Eigen::Isometry3d step_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d world_T_lidar_ = Eigen::Isometry3d::Identity();
};

}  // namespace

std::unique_ptr<OdometryEngine> MakeSmallGicp() {
  return std::make_unique<SmallGicp>();
}

}  // namespace mapweld::bench
