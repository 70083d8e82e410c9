// SPDX-License-Identifier: Apache-2.0
// KISS-ICP (https://github.com/PRBonn/kiss-icp) with its own defaults, one thread. De-skewing is off: the scans have no
// distortion.
#include <kiss_icp/pipeline/KissICP.hpp>

#include "tests/bench/odometry_engine.hpp"

namespace mapweld::bench {
namespace {

kiss_icp::pipeline::KISSConfig Config() {
  kiss_icp::pipeline::KISSConfig config;
  config.max_num_threads = 1;
  config.deskew = false;
  return config;
}

class KissIcp final : public OdometryEngine {
 public:
  [[nodiscard]] std::string name() const override { return "KISS-ICP"; }
  geom::Pose3 Register(const std::vector<Eigen::Vector3f>& points) override {
    std::vector<Eigen::Vector3d> frame;
    frame.reserve(points.size());
    for (const Eigen::Vector3f& p : points) frame.push_back(p.cast<double>());
    kiss_.RegisterFrame(frame, {});
    return {kiss_.pose().translation(), kiss_.pose().unit_quaternion()};
  }

 private:
  kiss_icp::pipeline::KissICP kiss_{Config()};
};

}  // namespace

std::unique_ptr<OdometryEngine> MakeKissIcp() {
  return std::make_unique<KissIcp>();
}

}  // namespace mapweld::bench
