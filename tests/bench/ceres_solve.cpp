// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/ceres_solve.hpp"

#if MAPWELD_HAVE_CERES
#include <ceres/ceres.h>

namespace mapweld::bench {
namespace {

// The error of ours, but for twice the vector part of the quaternion in place of its logarithm.
struct BetweenError {
  geom::Pose3 measured;
  geom::Mat6d root;  // root^T root = information

  template <class T>
  bool operator()(const T* t_a, const T* q_a, const T* t_b, const T* q_b, T* out) const {
    using Vec3 = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Vec3> ta(t_a);
    const Eigen::Map<const Vec3> tb(t_b);
    const Eigen::Map<const Eigen::Quaternion<T>> qa(q_a);
    const Eigen::Map<const Eigen::Quaternion<T>> qb(q_b);
    const Eigen::Quaternion<T> inverse = measured.q.conjugate().cast<T>();
    Eigen::Map<Eigen::Matrix<T, 6, 1>> residual(out);
    residual.template head<3>() = inverse * Vec3(qa.conjugate() * Vec3(tb - ta) - measured.t.cast<T>());
    residual.template tail<3>() = T(2) * (inverse * (qa.conjugate() * qb)).vec();
    residual.applyOnTheLeft(root.cast<T>());
    return true;
  }
};

}  // namespace

int SolveWithCeres(pose_graph::PoseGraph* graph, int max_iterations) {
  ceres::Problem problem;
  auto* manifold = new ceres::EigenQuaternionManifold;
  for (geom::Pose3& node : graph->world_T_node) {
    problem.AddParameterBlock(node.t.data(), 3);
    problem.AddParameterBlock(node.q.coeffs().data(), 4, manifold);
  }
  for (const pose_graph::Edge& edge : graph->edges) {
    const geom::Mat6d root = edge.information.llt().matrixU();
    geom::Pose3& a = graph->world_T_node[static_cast<std::size_t>(edge.a)];
    geom::Pose3& b = graph->world_T_node[static_cast<std::size_t>(edge.b)];
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<BetweenError, 6, 3, 4, 3, 4>(new BetweenError{edge.a_T_b, root}), nullptr,
        a.t.data(), a.q.coeffs().data(), b.t.data(), b.q.coeffs().data());
  }
  for (const int node : graph->held) {
    problem.SetParameterBlockConstant(graph->world_T_node[static_cast<std::size_t>(node)].t.data());
    problem.SetParameterBlockConstant(graph->world_T_node[static_cast<std::size_t>(node)].q.coeffs().data());
  }
  ceres::Solver::Options options;
  options.max_num_iterations = max_iterations;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  for (geom::Pose3& node : graph->world_T_node) node.q.normalize();
  return static_cast<int>(summary.iterations.size()) - 1;
}

}  // namespace mapweld::bench
#else
namespace mapweld::bench {
int SolveWithCeres(pose_graph::PoseGraph*, int) {
  return 0;
}
}  // namespace mapweld::bench
#endif
