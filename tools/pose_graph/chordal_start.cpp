// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_graph/chordal_start.hpp"

#include <Eigen/SVD>

#include "tools/pose_graph/block_cholesky.hpp"

namespace mapweld::pose_graph {
namespace {

using geom::Mat3d;
using geom::Pose3;
using geom::Vec3d;

// Adds |x_b - m x_a|^2 of one edge to the system, x of N rows and 3 columns, `offset` taken from x_b.
template <int N>
struct LinearTie {
  Eigen::Matrix<double, N, N> m;
  Eigen::Matrix<double, N, 3> offset = Eigen::Matrix<double, N, 3>::Zero();
  double weight = 0;
};

// Least squares over all edges. held(node) gives the value of a held node, tie(edge) what the edge says.
template <int N, class Tie, class Held>
std::optional<typename BlockCholesky<N>::template Rhs<3>> SolveLinear(const PoseGraph& graph,
                                                                      const GraphPattern& pattern, const Tie& tie,
                                                                      const Held& held) {
  BlockCholesky<N> system(&pattern.blocks);
  system.SetZero();
  typename BlockCholesky<N>::template Rhs<3> x(pattern.blocks.position.size());
  for (auto& block : x) block.setZero();
  for (const GraphPattern::Term& term : pattern.terms) {
    const Edge& edge = graph.edges[term.edge];
    const LinearTie<N> t = tie(edge);
    const int a = term.column_a;
    const int b = term.column_b;
    Eigen::Matrix<double, N, 3> target = t.offset;  // of x_b - m x_a
    if (a < 0) target += t.m * held(edge.a);
    if (b < 0) target -= held(edge.b);
    if (a >= 0) {
      system.diagonal(a) += t.weight * t.m.transpose() * t.m;
      x[static_cast<std::size_t>(a)] -= t.weight * t.m.transpose() * target;
    }
    if (b >= 0) {
      system.diagonal(b).diagonal().array() += t.weight;
      x[static_cast<std::size_t>(b)] += t.weight * target;
    }
    if (a >= 0 && b >= 0) {
      if (b > a) system.lower(term.block) -= t.weight * t.m;
      if (a > b) system.lower(term.block) -= t.weight * t.m.transpose();
    }
  }
  if (!system.Factorize()) return std::nullopt;
  system.template Solve<3>(&x);
  return x;
}

Mat3d NearestRotation(const Mat3d& m) {
  const Eigen::JacobiSVD<Mat3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) *= -1;
  return u * svd.matrixV().transpose();
}

}  // namespace

std::optional<std::vector<Pose3>> ChordalStart(const PoseGraph& graph, const GraphPattern& pattern) {
  std::vector<Pose3> out = graph.world_T_node;
  const auto at = [&](int node) -> const Pose3& { return out[static_cast<std::size_t>(node)]; };
  // Transposed rotations: x_b = (a_R_b)^T x_a, column by column.
  const auto rotations = SolveLinear<3>(
      graph, pattern,
      [](const Edge& edge) {
        LinearTie<3> tie;
        tie.m = edge.a_T_b.q.conjugate().toRotationMatrix();
        tie.weight = edge.weight * edge.information.bottomRightCorner<3, 3>().trace() / 3;
        return tie;
      },
      [&](int node) { return Mat3d(at(node).q.conjugate().toRotationMatrix()); });
  if (!rotations.has_value()) return std::nullopt;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (pattern.column[i] < 0) continue;
    const Mat3d& block = (*rotations)[static_cast<std::size_t>(pattern.column[i])];
    if (!block.allFinite()) return std::nullopt;
    out[i].q = geom::Quatd(NearestRotation(block.transpose())).normalized();
  }
  const auto positions = SolveLinear<1>(
      graph, pattern,
      [&](const Edge& edge) {
        LinearTie<1> tie;
        tie.m.setOnes();
        tie.offset = (at(edge.a).q * edge.a_T_b.t).transpose();
        tie.weight = edge.weight * edge.information.topLeftCorner<3, 3>().trace() / 3;
        return tie;
      },
      [&](int node) { return Eigen::RowVector3d(at(node).t.transpose()); });
  if (!positions.has_value()) return std::nullopt;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (pattern.column[i] < 0) continue;
    out[i].t = (*positions)[static_cast<std::size_t>(pattern.column[i])].transpose();
    if (!out[i].t.allFinite()) return std::nullopt;
  }
  return out;
}

}  // namespace mapweld::pose_graph
