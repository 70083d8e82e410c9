// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/registration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace mapweld::merge {
namespace {

using geom::Mat6d;
using geom::Pose3;
using geom::Vec3d;
using geom::Vec6d;

constexpr int kMinPartners = 50;

struct Normal {
  Mat6d h = Mat6d::Zero();
  Vec6d g = Vec6d::Zero();
  double squares = 0;  // of the Mahalanobis distances, unweighted
  double weight = 0;
  int partners = 0;
};

Eigen::Matrix3d Information(const Surfel& s) {
  Eigen::Matrix3f m;
  m << s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz;
  return m.cast<double>();
}

Normal Linearize(const PreparedSubmap& a, const PreparedSubmap& b, const Pose3& a_T_b, double gate_m, double sigma,
                 std::size_t stride) {
  Normal out;
  const Eigen::Matrix3d a_R_b = a_T_b.q.toRotationMatrix();
  for (std::size_t i = 0; i < b.samples().size(); i += stride) {
    const Vec3d p_b = b.points()[b.samples()[i]].cast<double>();
    const Vec3d p_a = a_R_b * p_b + a_T_b.t;
    const int at = a.NearestSurfel(p_a.cast<float>(), static_cast<float>(gate_m));
    if (at < 0) continue;
    const Surfel& surfel = a.surfels()[static_cast<std::size_t>(at)];
    const Vec3d r = p_a - surfel.mean.cast<double>();
    const Eigen::Matrix3d w = Information(surfel);
    const double squared = r.dot(w * r);
    const double share = sigma * sigma / (sigma * sigma + squared);
    const double weight = share * share;
    Eigen::Matrix<double, 3, 6> j;
    j.leftCols<3>() = a_R_b;
    j.rightCols<3>() = -a_R_b * geom::Skew(p_b);
    const Eigen::Matrix<double, 6, 3> jw = weight * (j.transpose() * w);
    out.h.noalias() += jw * j;
    out.g.noalias() += jw * r;
    out.squares += squared;
    out.weight += weight;
    ++out.partners;
  }
  return out;
}

// Holds the tilt of a_T_b near zero. `partners` makes it count like a fixed share of the measurements.
void AddLevelPrior(const Pose3& a_T_b, double tilt_sigma_rad, int partners, Normal* normal) {
  // z of b in a's frame, x and y: turns by R_xy (w_y, -w_x) for a right perturbation w.
  const Eigen::Matrix3d r = a_T_b.q.toRotationMatrix();
  Eigen::Matrix<double, 2, 6> j = Eigen::Matrix<double, 2, 6>::Zero();
  j.col(3) = -r.col(1).head<2>();
  j.col(4) = r.col(0).head<2>();
  const double w = 0.01 * partners / (tilt_sigma_rad * tilt_sigma_rad);
  normal->h += w * j.transpose() * j;
  normal->g += w * j.transpose() * r.col(2).head<2>();
}

bool Descend(const PreparedSubmap& a, const PreparedSubmap& b, double gate_m, std::size_t stride,
             const RegistrationConfig& config, Registration* out) {
  for (int i = 0; i < config.iterations; ++i) {
    Normal normal = Linearize(a, b, out->a_T_b, gate_m, config.kernel_sigma, stride);
    if (normal.partners < kMinPartners / static_cast<int>(stride)) return false;
    AddLevelPrior(out->a_T_b, config.tilt_sigma_rad, normal.partners, &normal);
    normal.h.diagonal().array() += 1e-6 * normal.h.trace();
    const Vec6d step = normal.h.ldlt().solve(-normal.g);
    if (!step.allFinite()) return false;
    out->a_T_b = geom::Retract(out->a_T_b, step);
    if (step.head<3>().norm() < 0.01 && step.tail<3>().norm() < 0.0004) return true;
  }
  return false;
}

// Agreement by blocks of the ground, in a's frame. Partners by chance are spread thin over all of it; where two places
// only resemble each other in part, whole blocks disagree.
class Blocks {
 public:
  void Count(const Eigen::Vector3f& p_a, bool found) {
    const int x = static_cast<int>((p_a.x() + PreparedSubmap::kHalfSize_m) / kBlock_m);
    const int y = static_cast<int>((p_a.y() + PreparedSubmap::kHalfSize_m) / kBlock_m);
    if (x < 0 || y < 0 || x >= kSide || y >= kSide) return;
    Block& block = blocks_[static_cast<std::size_t>(x * kSide + y)];
    ++block.covered;
    block.found += found ? 1 : 0;
  }
  [[nodiscard]] double TornShare() const {
    int judged = 0;
    int torn = 0;
    for (const Block& block : blocks_) {
      if (block.covered < kMinCovered) continue;
      ++judged;
      torn += block.found < kTorn * block.covered ? 1 : 0;
    }
    return judged > 0 ? static_cast<double>(torn) / judged : 1;
  }

 private:
  static constexpr float kBlock_m = 8;
  static constexpr int kSide = static_cast<int>(2 * PreparedSubmap::kHalfSize_m / kBlock_m);
  static constexpr int kMinCovered = 10;
  static constexpr double kTorn = 0.35;  // less is found by chance in most blocks of unrelated places
  struct Block {
    int covered = 0;
    int found = 0;
  };
  std::array<Block, static_cast<std::size_t>(kSide) * kSide> blocks_{};
};

struct Partners {
  int covered = 0;
  int found = 0;
  double squares = 0;  // m^2 across the shapes
  [[nodiscard]] double Share() const { return covered > 0 ? static_cast<double>(found) / covered : 0; }
};

Partners CountPartners(const PreparedSubmap& target, const PreparedSubmap& source, const Pose3& target_T_source,
                       double distance_m, std::size_t stride, Blocks* blocks = nullptr, bool target_is_a = true) {
  Partners out;
  const Eigen::Matrix3f rotation = target_T_source.q.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = target_T_source.t.cast<float>();
  for (std::size_t i = 0; i < source.structure_samples().size(); i += stride) {
    const Eigen::Vector3f& p_source = source.points()[source.structure_samples()[i]];
    const Eigen::Vector3f p = rotation * p_source + translation;
    if (!target.Covers(p)) continue;
    ++out.covered;
    const bool found = target.HasPoint(p, static_cast<float>(distance_m));
    if (blocks != nullptr) blocks->Count(target_is_a ? p : p_source, found);
    if (!found) continue;
    ++out.found;
    const int at = target.NearestSurfel(p, 1.5F);
    if (at < 0) continue;
    const Surfel& surfel = target.surfels()[static_cast<std::size_t>(at)];
    const Vec3d r = (p - surfel.mean).cast<double>();
    const Eigen::Matrix3d w = Information(surfel);
    out.squares += 3 * r.dot(w * r) / w.trace();
  }
  return out;
}

void Judge(const PreparedSubmap& a, const PreparedSubmap& b, const RegistrationConfig& config, Registration* out) {
  Blocks blocks;
  const Partners of_b = CountPartners(a, b, out->a_T_b, config.partner_distance_m, 1, &blocks, true);
  const Partners of_a = CountPartners(b, a, out->a_T_b.Inverse(), config.partner_distance_m, 1, &blocks, false);
  out->torn_share = blocks.TornShare();
  out->overlap_of_b = of_b.Share();
  out->overlap_of_a = of_a.Share();
  out->covered = of_a.covered + of_b.covered;
  const auto all = static_cast<double>(a.structure_samples().size() + b.structure_samples().size());
  out->covered_share = all > 0 ? out->covered / all : 0;
  const int found = of_a.found + of_b.found;
  out->residual_m = found > 0 ? std::sqrt((of_a.squares + of_b.squares) / found) : 0;
  double chance = 0;
  constexpr int kDirections = 8;
  for (const double distance_m : {0.5 * config.decoy_distance_m, config.decoy_distance_m}) {
    for (int i = 0; i < kDirections; ++i) {
      const double angle_rad = 2 * std::numbers::pi * i / kDirections;
      Pose3 decoy = out->a_T_b;
      decoy.t += distance_m * Vec3d(std::cos(angle_rad), std::sin(angle_rad), 0);
      chance = std::max(chance, CountPartners(a, b, decoy, config.partner_distance_m, 2).Share());
    }
  }
  out->chance = chance;
}

}  // namespace

Pose3 WithGroundHeight(const PreparedSubmap& a, const PreparedSubmap& b, const Pose3& guess_a_T_b) {
  constexpr int kCells = PreparedSubmap::kCoverCells;
  constexpr float kCell_m = 4;
  std::vector<double> differences;
  for (int x = 0; x < kCells; ++x) {
    for (int y = 0; y < kCells; ++y) {
      const float z_b = b.lowest()[static_cast<std::size_t>(x * kCells + y)];
      if (std::isnan(z_b)) continue;
      const Vec3d p_b((static_cast<double>(x) + 0.5) * 4 - 64, (static_cast<double>(y) + 0.5) * 4 - 64,
                      static_cast<double>(z_b));
      Pose3 flat = guess_a_T_b;
      flat.t.z() = 0;
      const Vec3d p_a = flat * p_b;
      const int ax = static_cast<int>(std::floor((p_a.x() + 64) / static_cast<double>(kCell_m)));
      const int ay = static_cast<int>(std::floor((p_a.y() + 64) / static_cast<double>(kCell_m)));
      if (ax < 0 || ay < 0 || ax >= kCells || ay >= kCells) continue;
      const float z_a = a.lowest()[static_cast<std::size_t>(ax * kCells + ay)];
      if (!std::isnan(z_a)) differences.push_back(static_cast<double>(z_a) - p_a.z());
    }
  }
  Pose3 out = guess_a_T_b;
  if (differences.size() < 5) return out;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  out.t.z() = *middle;
  return out;
}

Registration Register(const PreparedSubmap& a, const PreparedSubmap& b, const Pose3& guess_a_T_b,
                      const RegistrationConfig& config) {
  return RegisterBest(a, b, {&guess_a_T_b, 1}, config);
}

Registration RegisterBest(const PreparedSubmap& a, const PreparedSubmap& b, std::span<const Pose3> guesses_a_T_b,
                          const RegistrationConfig& config) {
  constexpr std::size_t kFirstStride = 4;
  Registration out;
  double best_overlap = -1;
  for (const Pose3& guess : guesses_a_T_b) {
    Registration candidate;
    candidate.a_T_b = guess;
    (void)Descend(a, b, config.first_gate_m, kFirstStride, config, &candidate);
    if (guesses_a_T_b.size() > 1) {
      const double distance_m = config.partner_distance_m;
      const double of_b = CountPartners(a, b, candidate.a_T_b, distance_m, kFirstStride).Share();
      const double of_a = CountPartners(b, a, candidate.a_T_b.Inverse(), distance_m, kFirstStride).Share();
      if (std::min(of_a, of_b) <= best_overlap) continue;
      best_overlap = std::min(of_a, of_b);
    }
    out = candidate;
  }
  if (guesses_a_T_b.empty()) return out;
  const double middle_gate_m = 0.5 * (config.first_gate_m + config.last_gate_m);
  (void)Descend(a, b, middle_gate_m, 2, config, &out);
  out.converged = Descend(a, b, config.last_gate_m, 1, config, &out);
  const Normal normal = Linearize(a, b, out.a_T_b, config.last_gate_m, config.kernel_sigma, 1);
  if (normal.partners < kMinPartners || !out.a_T_b.IsValid()) {
    out.converged = false;
    return out;
  }
  out.information = normal.h;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> slide(normal.h.topLeftCorner<2, 2>());
  out.slide_ratio = slide.eigenvalues()(0) / std::max(1e-9, slide.eigenvalues()(1));
  Judge(a, b, config, &out);
  return out;
}

}  // namespace mapweld::merge
