// SPDX-License-Identifier: Apache-2.0
// GICP of the Point Cloud Library, scan to scan, on the same voxel size as small_gicp.
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>

#include "tests/bench/odometry_engine.hpp"

namespace mapweld::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

class PclGicp final : public OdometryEngine {
 public:
  [[nodiscard]] std::string name() const override { return "PCL GICP"; }
  geom::Pose3 Register(const std::vector<Eigen::Vector3f>& points) override {
    const auto all = std::make_shared<Cloud>();
    for (const Eigen::Vector3f& p : points) all->push_back({p.x(), p.y(), p.z()});
    const auto cloud = std::make_shared<Cloud>();
    pcl::VoxelGrid<pcl::PointXYZ> grid;
    grid.setLeafSize(0.25F, 0.25F, 0.25F);
    grid.setInputCloud(all);
    grid.filter(*cloud);
    if (last_ != nullptr) {
      pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> gicp;
      gicp.setMaxCorrespondenceDistance(1.0);
      gicp.setInputSource(cloud);
      gicp.setInputTarget(last_);
      Cloud aligned;
      gicp.align(aligned, step_);
      step_ = gicp.getFinalTransformation();
      const Eigen::Matrix4d step = step_.cast<double>();
      const geom::Quatd turn = geom::Quatd(Eigen::Matrix3d(step.topLeftCorner<3, 3>())).normalized();
      world_T_lidar_ = world_T_lidar_ * geom::Pose3{step.topRightCorner<3, 1>(), turn};
    }
    last_ = cloud;
    return world_T_lidar_;
  }

 private:
  Cloud::Ptr last_;
  Eigen::Matrix4f step_ = Eigen::Matrix4f::Identity();
  geom::Pose3 world_T_lidar_;
};

}  // namespace

std::unique_ptr<OdometryEngine> MakePclGicp() {
  return std::make_unique<PclGicp>();
}

}  // namespace mapweld::bench
