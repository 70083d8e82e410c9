// SPDX-License-Identifier: Apache-2.0
// A recording on disk (scans with the poses of some odometry) made into a Drive with its submaps, the same that an
// agent would have sent: keyframes every 5 m of path, submaps from the scans around each, one description per submap.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "core/geom/pose3.hpp"
#include "tools/merge/drive.hpp"
#include "tools/merge/progress.hpp"

namespace mapweld::merge {

// times, world_T_lidar and the scans have one index. `world` is any frame at all: gravity is found again.
struct Recording {
  std::string name;
  std::vector<TimeNs> times;
  std::vector<geom::Pose3> world_T_lidar;
  std::function<std::vector<Eigen::Vector3f>(int)> load_scan;  // lidar frame; called from several threads at once
};

struct RecordingConfig {
  double keyframe_spacing_m = 5;
  double path_window_m = 40;    // scans this far along the path before and after a keyframe make its submap
  double radius_m = 50;         // of a submap, horizontal
  double voxel_m = 0.5;         // one point per occupied voxel: the mean
  double scan_spacing_m = 0.5;  // scans closer together than this along the path add cost, not shape
  double scan_voxel_m = 0.25;   // each scan is thinned to this before it is used in up to 16 submaps
  int threads = 0;              // 0: all of the machine
};

// The body frame is the lidar frame. odom is `world` turned so that z is up, with the first scan's position as origin.
struct RecordedDrive {
  Drive drive;
  std::vector<SubmapCloud> submaps;  // per keyframe
  geom::Pose3 odom_T_world;
  std::vector<geom::Pose3> odom_T_scan;  // per scan
  std::vector<double> scan_path_m;       // per scan, along the path
};

// Throws std::runtime_error for a recording without two scans, with a broken pose or with fewer times than poses.
// Memory: the submaps (about 15 k points each) and, per thread, the scans of one 80 m window. The result does not
// depend on the number of threads.
RecordedDrive BuildDrive(const Recording& recording, const RecordingConfig& config, Progress* progress);

// Rotation that takes the mean of the scans' z axes to z: the lidar is taken to be level on average.
geom::Quatd LevelingRotation(const std::vector<geom::Pose3>& world_T_lidar);

// One merged pose per scan: the correction of the keyframes before and after it, blended by path length.
// `merged_T_body` is of the drive's keyframes, as in MergeResult.
std::vector<geom::Pose3> MergedScanPoses(const RecordedDrive& recorded, const std::vector<geom::Pose3>& merged_T_body);

// Submaps of recordings, all present. The drives must outlive it.
class RecordedSubmaps : public SubmapSource {
 public:
  explicit RecordedSubmaps(const std::vector<RecordedDrive>& drives) : drives_(&drives) {}
  std::shared_ptr<const SubmapCloud> Find(SubmapKey key) override;

 private:
  const std::vector<RecordedDrive>* drives_;
};

}  // namespace mapweld::merge
