// SPDX-License-Identifier: Apache-2.0
// The keyframes that place recognition is measured on, and which of them truly show the same place.
#pragma once

#include <string>
#include <vector>

#include "core/geom/pose3.hpp"

namespace mapweld::eval {

enum class Direction { kForward, kReverse, kCrossing };  // below 60 degrees, above 120, between

class PlaceSet {
 public:
  // With one session, what can be recognised are its own keyframes at least this much path earlier; with several, the
  // keyframes of all other sessions.
  static constexpr double kRevisitGap_m = 60;

  // `positions` of one session in order of time, m; all sessions in one frame. Throws std::runtime_error for less than
  // three keyframes.
  void AddSession(const std::string& name, const std::vector<geom::Vec3d>& positions);

  [[nodiscard]] int size() const { return static_cast<int>(keyframes_.size()); }
  [[nodiscard]] int sessions() const { return sessions_; }
  // May j be an answer to query i?
  [[nodiscard]] bool IsCandidate(int query, int j) const;
  // In three dimensions, so that a bridge is not the street under it.
  [[nodiscard]] double Metres(int i, int j) const;
  [[nodiscard]] const geom::Vec3d& Position(int i) const { return At(i).position; }
  // The place `left_m` to the left of a keyframe, as the vehicle travels.
  [[nodiscard]] geom::Vec3d LeftOf(int i, double left_m) const;
  // By the directions of travel, each from the keyframe before to the keyframe after, in the plane.
  [[nodiscard]] Direction DirectionBetween(int i, int j) const;

 private:
  struct Keyframe {
    int session = 0;
    geom::Vec3d position;
    Eigen::Vector2d travel;  // unit length, or zero where the vehicle stood
    double path_m = 0;
  };
  [[nodiscard]] const Keyframe& At(int i) const { return keyframes_[static_cast<std::size_t>(i)]; }

  std::vector<Keyframe> keyframes_;
  int sessions_ = 0;
};

}  // namespace mapweld::eval
