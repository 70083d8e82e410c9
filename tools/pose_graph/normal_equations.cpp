// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_graph/normal_equations.hpp"

#include <algorithm>

namespace mapweld::pose_graph {
namespace {

using geom::Mat3d;
using geom::Mat6d;
using geom::Pose3;
using geom::Vec3d;
using geom::Vec6d;

// What one edge adds, as geom::LinearizeBetween says it. jacobian_a = -jacobian_b * turn, where turn carries a motion
// of a over to b; so all blocks follow from that of b, with products of 3 x 3.
struct EdgeBlocks {
  Mat6d bb;
  Mat6d ab;
  Mat6d aa;
  Vec6d gradient_a;
  Vec6d gradient_b;
  double chi2;
};

// turn^T * m, turn = [R^T, -R^T [t]x; 0, R^T]
Mat6d TurnedBack(const Mat3d& a_R_b, const Vec3d& a_t_b, const Mat6d& m) {
  Mat6d out;
  out.topRows<3>().noalias() = a_R_b * m.topRows<3>();
  out.bottomRows<3>().noalias() = a_R_b * m.bottomRows<3>();
  for (Eigen::Index k = 0; k < 6; ++k) out.col(k).tail<3>() += a_t_b.cross(out.col(k).head<3>());
  return out;
}

void Linearize(const Pose3& a, const Pose3& b, const Mat3d& world_R_a, const Mat3d& world_R_b, const Edge& edge,
               EdgeBlocks* out) {
  const Mat3d a_R_b = world_R_a.transpose() * world_R_b;
  const Vec3d a_t_b = world_R_a.transpose() * (b.t - a.t);
  const Mat3d measured_R_inverse = edge.a_T_b.q.conjugate().toRotationMatrix();
  Vec6d residual;
  residual.head<3>() = measured_R_inverse * (a_t_b - edge.a_T_b.t);
  residual.tail<3>() = geom::LogSo3((edge.a_T_b.q.conjugate() * (a.q.conjugate() * b.q)).normalized());
  const Mat3d move = measured_R_inverse * a_R_b;  // jacobian_b: this and `turn` on its diagonal
  const Mat3d turn = geom::RightJacobianInverseSo3(residual.tail<3>());
  const Mat6d information = edge.weight * edge.information;
  const Vec6d force = information * residual;
  out->chi2 = residual.dot(force);
  Mat6d half;  // information * jacobian_b
  half.leftCols<3>().noalias() = information.leftCols<3>() * move;
  half.rightCols<3>().noalias() = information.rightCols<3>() * turn;
  out->bb.topRows<3>().noalias() = move.transpose() * half.topRows<3>();
  out->bb.bottomRows<3>().noalias() = turn.transpose() * half.bottomRows<3>();
  out->gradient_b.head<3>().noalias() = move.transpose() * force.head<3>();
  out->gradient_b.tail<3>().noalias() = turn.transpose() * force.tail<3>();
  const Mat6d carried = TurnedBack(a_R_b, a_t_b, out->bb);
  out->ab = -carried;
  out->aa = TurnedBack(a_R_b, a_t_b, carried.transpose());
  out->gradient_a.head<3>() = -(a_R_b * out->gradient_b.head<3>());
  out->gradient_a.tail<3>() = -(a_R_b * out->gradient_b.tail<3>()) + a_t_b.cross(Vec3d(out->gradient_a.head<3>()));
}

}  // namespace

NormalEquations::NormalEquations(const PoseGraph* graph, const GraphPattern* pattern)
    : graph_(graph),
      pattern_(pattern),
      world_R_node_(graph->world_T_node.size()),
      system_(&pattern->blocks),
      gradient_(pattern->blocks.position.size()),
      step_(pattern->blocks.position.size()) {}

double NormalEquations::Linearize(const std::vector<Pose3>& world_T_node) {
  for (std::size_t i = 0; i < world_T_node.size(); ++i) world_R_node_[i] = world_T_node[i].q.toRotationMatrix();
  system_.SetZero();
  for (Vec6d& block : gradient_) block.setZero();
  double sum = 0;
  EdgeBlocks blocks;
  for (const GraphPattern::Term& term : pattern_->terms) {
    const Edge& edge = graph_->edges[term.edge];
    const auto a = static_cast<std::size_t>(edge.a);
    const auto b = static_cast<std::size_t>(edge.b);
    pose_graph::Linearize(world_T_node[a], world_T_node[b], world_R_node_[a], world_R_node_[b], edge, &blocks);
    sum += blocks.chi2;
    if (term.column_a >= 0) {
      system_.diagonal(term.column_a) += blocks.aa;
      gradient_[static_cast<std::size_t>(term.column_a)] += blocks.gradient_a;
    }
    if (term.column_b >= 0) {
      system_.diagonal(term.column_b) += blocks.bb;
      gradient_[static_cast<std::size_t>(term.column_b)] += blocks.gradient_b;
    }
    if (term.column_a < 0 || term.column_b < 0) continue;
    if (term.column_a > term.column_b) {
      system_.lower(term.block) += blocks.ab;
    } else {
      system_.lower(term.block) += blocks.ab.transpose();
    }
  }
  return 0.5 * sum;
}

bool NormalEquations::Solve(double damping) {
  for (int k = 0; damping > 0 && k < pattern_->blocks.columns(); ++k) system_.diagonal(k).diagonal() *= 1 + damping;
  if (!system_.Factorize()) return false;
  for (std::size_t k = 0; k < step_.size(); ++k) step_[k] = -gradient_[k];
  system_.Solve<1>(&step_);
  largest_step_ = 0;
  for (std::size_t k = 0; k < step_.size(); ++k) {
    if (!step_[k].allFinite()) return false;
    largest_step_ = std::max(largest_step_, step_[k].cwiseAbs().maxCoeff());
  }
  return true;
}

Vec6d NormalEquations::Step(int node) const {
  const int column = pattern_->column[static_cast<std::size_t>(node)];
  return column < 0 ? Vec6d(Vec6d::Zero()) : step_[static_cast<std::size_t>(column)];
}

}  // namespace mapweld::pose_graph
