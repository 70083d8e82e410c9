// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/loop_finder.hpp"

#include <algorithm>
#include <cmath>

#include "tools/merge/bev_search.hpp"

namespace mapweld::merge {
namespace {

using geom::Pose3;
using geom::Vec3d;

constexpr int kPeaks = 4;

std::vector<Pose3> LevelPoses(const Drive& drive) {
  std::vector<Pose3> out;
  for (const Keyframe& keyframe : drive.keyframes) out.push_back(geom::Level(keyframe.odom_T_body));
  return out;
}

geom::OrientedBox VolumeOf(const PreparedSubmap& submap, const Pose3& a_T_submap) {
  const Vec3d low = submap.low().cast<double>();
  const Vec3d high = submap.high().cast<double>();
  const Pose3 submap_T_box{0.5 * (low + high), geom::Quatd::Identity()};
  return {a_T_submap * submap_T_box, 0.5 * (high - low)};
}

double Tilt(const Pose3& pose) {
  return std::acos(std::clamp((pose.q * Vec3d::UnitZ()).z(), -1.0, 1.0));
}

}  // namespace

LoopFinder::LoopFinder(const Drive& a, int index_a, const Drive& b, int index_b, PreparedCache* submaps,
                       const MergeConfig& config)
    : a_(&a),
      b_(&b),
      index_a_(index_a),
      index_b_(index_b),
      submaps_(submaps),
      config_(&config),
      level_a_(LevelPoses(a)),
      level_b_(LevelPoses(b)) {}

std::shared_ptr<const PreparedSubmap> LoopFinder::Submap(SubmapKey key) {
  std::shared_ptr<const PreparedSubmap> submap = submaps_->Get(key);
  asked_[key] = submap != nullptr;
  return submap;
}

Pose3 LoopFinder::Predict(const VerifiedLoop& from, int to_a, int to_b) const {
  const Pose3 from_level = geom::Level(from.a_T_b);
  return LevelA(to_a).Inverse() * LevelA(from.a) * from_level * (LevelB(from.b).Inverse() * LevelB(to_b));
}

LoopTry LoopFinder::Judge(int a, int b, const Registration& registration, double least_evidence) const {
  const VerifyConfig& verify = config_->verify;
  LoopTry out;
  out.loop = {a,
              b,
              registration.a_T_b,
              registration.Evidence(),
              registration.Overlap(),
              registration.residual_m,
              registration.torn_share};
  if (!registration.converged) {
    out.test = "registration";
  } else if (registration.covered_share < verify.min_covered_share) {
    out.test = "little in common";
  } else if (Tilt(registration.a_T_b) > verify.max_tilt_rad) {
    out.test = "tilt";
  } else if (registration.Evidence() < least_evidence) {
    out.comparable = true;
    out.test = "overlap ratio";
    if (registration.Overlap() >= verify.slide_overlap) {
      out.answer = LoopTry::Answer::kUnclear;
      out.test = "slides along the street";
    }
  } else {
    out.comparable = true;
    out.answer = LoopTry::Answer::kSame;
  }
  return out;
}

LoopTry LoopFinder::Search(int a, int b) {
  const auto submap_a = Submap({index_a_, a});
  const auto submap_b = Submap({index_b_, b});
  if (submap_a == nullptr || submap_b == nullptr) {
    LoopTry out;
    out.answer = LoopTry::Answer::kMissing;
    out.test = "submaps missing";
    return out;
  }
  std::vector<Pose3> guesses;
  for (const BevPeak& peak : SearchBev(*submap_a, *submap_b, kPeaks)) {
    const Pose3 guess{{peak.x_m, peak.y_m, 0}, geom::Quatd(Eigen::AngleAxisd(peak.yaw_rad, Vec3d::UnitZ()))};
    guesses.push_back(WithGroundHeight(*submap_a, *submap_b, guess));
  }
  const Registration registration = RegisterBest(*submap_a, *submap_b, guesses, config_->registration);
  return Judge(a, b, registration, config_->verify.seed_evidence);
}

LoopTry LoopFinder::Check(int a, int b, const Pose3& predicted_a_T_b, double slack_m) {
  const auto submap_a = Submap({index_a_, a});
  const auto submap_b = Submap({index_b_, b});
  LoopTry out;
  out.loop = {a, b, predicted_a_T_b, 0, 0, 0, 1};
  if (submap_a == nullptr || submap_b == nullptr) {
    out.answer = LoopTry::Answer::kMissing;
    out.test = "submaps missing";
    return out;
  }
  const Registration registration = Register(*submap_a, *submap_b, predicted_a_T_b, config_->registration);
  out = Judge(a, b, registration, config_->verify.loop_evidence);
  if (out.answer == LoopTry::Answer::kDifferent) return out;
  const Pose3 jump = predicted_a_T_b.Inverse() * registration.a_T_b;
  if (jump.t.norm() > slack_m || geom::LogSo3(jump.q).norm() > config_->verify.max_jump_rad) {
    out.answer = LoopTry::Answer::kDifferent;
    out.test = "odometry";
  }
  return out;
}

bool LoopFinder::VolumesMeet(int a, int b, const Pose3& a_T_b) {
  const auto submap_a = Submap({index_a_, a});
  const auto submap_b = Submap({index_b_, b});
  if (submap_a == nullptr || submap_b == nullptr) return true;
  return geom::BoxesOverlap(VolumeOf(*submap_a, Pose3{}), VolumeOf(*submap_b, a_T_b));
}

}  // namespace mapweld::merge
