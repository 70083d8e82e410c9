// SPDX-License-Identifier: Apache-2.0
// What the merge works on, whoever delivers it: agents over LCM (mapweld serve) or recordings on disk (mapweld merge).
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/time.hpp"
#include "core/geom/pose3.hpp"
#include "core/place/descriptor.hpp"

namespace mapweld::merge {

struct Keyframe {
  TimeNs t;
  geom::Pose3 odom_T_body;
  place::PlaceDescription place;
  double path_m = 0;     // m travelled since the drive began
  bool flushed = false;  // its submap is incomplete, because the drive ended
};

// One uninterrupted odometry: all poses in one gravity-aligned frame `odom` of its own. Keyframes in order, about 5 m
// apart.
struct Drive {
  std::string name;  // unique
  std::vector<Keyframe> keyframes;
};

// Points of one submap in the level frame of its keyframe (core/submap/submap.hpp), one per occupied 0.5 m voxel.
struct SubmapCloud {
  std::vector<Eigen::Vector3f> points;
};

// Names one submap: index of the drive in the list given to the merge, index of the keyframe in the drive.
struct SubmapKey {
  int drive = 0;
  int keyframe = 0;
  auto operator<=>(const SubmapKey&) const = default;
};

// Where the merge gets submaps. Find returns null for one that has not arrived yet; the merge then goes on without it
// and lists it as missing, so that the caller can fetch it and merge again. Called by several threads at once.
class SubmapSource {
 public:
  virtual ~SubmapSource() = default;
  virtual std::shared_ptr<const SubmapCloud> Find(SubmapKey key) = 0;
  // Whether Find has it. A source that need not decode a cloud to know should say so itself.
  virtual bool Has(SubmapKey key) { return Find(key) != nullptr; }
};

// For sources that keep their clouds anyway, longer than anyone asks for them.
inline std::shared_ptr<const SubmapCloud> Kept(const SubmapCloud* cloud) {
  return {std::shared_ptr<const SubmapCloud>{}, cloud};
}

// Only every `step`-th submap of each drive: enough for a map when they lie closer than they reach.
class ThinnedSubmaps final : public SubmapSource {
 public:
  ThinnedSubmaps(SubmapSource* all, int step) : all_(all), step_(step) {}
  std::shared_ptr<const SubmapCloud> Find(SubmapKey key) override { return IsKept(key) ? all_->Find(key) : nullptr; }
  bool Has(SubmapKey key) override { return IsKept(key) && all_->Has(key); }

 private:
  [[nodiscard]] bool IsKept(SubmapKey key) const { return key.keyframe % step_ == 0; }

  SubmapSource* all_;
  int step_;
};

}  // namespace mapweld::merge
