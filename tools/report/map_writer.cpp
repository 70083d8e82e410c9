// SPDX-License-Identifier: Apache-2.0
#include "tools/report/map_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "tools/io/atomic_file.hpp"
#include "tools/io/g2o.hpp"
#include "tools/io/kitti.hpp"
#include "tools/io/pcd.hpp"
#include "tools/io/ply.hpp"
#include "tools/io/unique_names.hpp"

namespace mapweld::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const merge::Drive& DriveAt(const std::vector<merge::Drive>& drives, int drive) {
  return drives.at(static_cast<std::size_t>(drive));
}

Json Matrix4(const geom::Pose3& pose) {
  const Eigen::Matrix3d r = pose.q.toRotationMatrix();
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < 3; ++i) rows.push_back({r(i, 0), r(i, 1), r(i, 2), pose.t(i)});
  rows.push_back({0, 0, 0, 1});
  return rows;
}

Json LoopJson(const merge::Loop& loop) {
  return {{"keyframe_a", loop.keyframe_a},       {"keyframe_b", loop.keyframe_b}, {"a_T_b", Matrix4(loop.a_T_b)},
          {"overlap_ratio", loop.overlap_ratio}, {"residual_m", loop.residual_m}, {"weight", loop.weight}};
}

// Names come from folders and may hold any bytes: what is no UTF-8 is replaced instead of failing the whole merge.
std::string Text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

// Remembers what it wrote, so that leftovers can be told from it.
class OutputFolder {
 public:
  explicit OutputFolder(fs::path folder) : folder_(std::move(folder)) {}

  fs::path File(const fs::path& relative) {
    const fs::path path = folder_ / relative;
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) {
      throw std::runtime_error(fmt::format("cannot create {}: {}; choose an output folder that you may write to",
                                           path.parent_path().string(), error.message()));
    }
    written_.insert(path);
    return path;
  }

  // Only names that this program writes are touched; folders go only when nothing is left in them.
  void RemoveLeftovers() const {
    std::vector<fs::path> groups;
    std::vector<fs::path> trajectories;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      const bool numbered = name.size() > 6 && name.find_first_not_of("0123456789", 6) == std::string::npos;
      if (entry.is_directory() && name.starts_with("group_") && numbered) groups.push_back(entry.path());
      const bool ours = name.ends_with(".tum") || name.ends_with(".kitti.txt");
      if (entry.is_regular_file() && name.starts_with("trajectory_") && ours) trajectories.push_back(entry.path());
    }
    for (const fs::path& trajectory : trajectories) RemoveLeftover(trajectory);
    for (const fs::path& group : groups) {
      for (const char* name : {"map.ply", "map.pcd", "pose_graph.g2o"}) RemoveLeftover(group / name);
      std::error_code not_empty;
      fs::remove(group, not_empty);
    }
  }

 private:
  void RemoveLeftover(const fs::path& path) const {
    std::error_code error;
    if (!written_.contains(path)) fs::remove(path, error);
  }

  fs::path folder_;
  std::set<fs::path> written_;
};

std::vector<io::StampedPose> KeyframePoses(const merge::Drive& drive, const std::vector<geom::Pose3>& merged_T_body) {
  std::vector<io::StampedPose> stamped;
  for (std::size_t k = 0; k < drive.keyframes.size(); ++k) {
    stamped.push_back({drive.keyframes[k].t, merged_T_body.at(k)});
  }
  return stamped;
}

void WriteTrajectory(const std::string& name, const std::vector<io::StampedPose>& trajectory, OutputFolder* output) {
  io::WriteTum(output->File("trajectory_" + name + ".tum"), trajectory);
  std::vector<geom::Pose3> rows;
  for (const io::StampedPose& pose : trajectory) rows.push_back(pose.world_T_body);
  io::WriteKittiPoses(output->File("trajectory_" + name + ".kitti.txt"), rows);
}

geom::Mat6d Information(double sigma_m, double sigma_rad) {
  geom::Vec6d diagonal;
  diagonal << geom::Vec3d::Constant(1 / (sigma_m * sigma_m)), geom::Vec3d::Constant(1 / (sigma_rad * sigma_rad));
  return diagonal.asDiagonal();
}

}  // namespace

std::string GroupsJson(const std::vector<merge::Drive>& drives, const merge::MergeResult& result) {
  Json groups = Json::array();
  for (const std::vector<int>& group : result.groups) {
    Json names = Json::array();
    for (const int drive : group) names.push_back(DriveAt(drives, drive).name);
    groups.push_back({{"recordings", names}});
  }
  return Text({{"groups", groups}});
}

std::string OverlapsJson(const std::vector<merge::Drive>& drives, const merge::MergeResult& result) {
  Json overlaps = Json::array();
  for (const merge::Overlap& overlap : result.overlaps) {
    Json entry;
    entry["pair"] = {DriveAt(drives, overlap.drive_a).name, DriveAt(drives, overlap.drive_b).name};
    entry["verdict"] = overlap.accepted ? "accepted" : "rejected";
    entry["test"] = overlap.test;
    entry["group"] = nullptr;
    const int group_a = result.group_of.at(static_cast<std::size_t>(overlap.drive_a));
    if (group_a == result.group_of.at(static_cast<std::size_t>(overlap.drive_b))) entry["group"] = group_a + 1;
    entry["reverse"] = overlap.reverse;
    entry["length_m"] = overlap.length_m;
    entry["weight"] = overlap.weight;
    entry["transform"] = Matrix4(overlap.a_T_b);
    entry["matches"] = Json::array();
    for (const auto& [a, b] : overlap.matches) entry["matches"].push_back({a, b});
    entry["loops"] = Json::array();
    for (const merge::Loop& loop : overlap.loops) entry["loops"].push_back(LoopJson(loop));
    overlaps.push_back(std::move(entry));
  }
  return Text({{"overlaps", overlaps}});
}

void WritePoseGraph(const fs::path& path, const std::vector<merge::Drive>& drives, const merge::MergeResult& result,
                    int group) {
  // Round figures for other optimisers to start from: 10 cm and 0.6 degrees between keyframes, twice that for a loop.
  const geom::Mat6d odometry = Information(0.1, 0.01);
  const geom::Mat6d registration = Information(0.2, 0.02);
  std::vector<std::int64_t> first_id;
  std::int64_t next_id = 0;
  for (const merge::Drive& drive : drives) {
    first_id.push_back(next_id);
    next_id += static_cast<std::int64_t>(drive.keyframes.size());
  }
  io::PoseGraphFile graph;
  const std::vector<int>& members = result.groups.at(static_cast<std::size_t>(group));
  for (const int drive : members) {
    const auto d = static_cast<std::size_t>(drive);
    const std::vector<merge::Keyframe>& keyframes = drives.at(d).keyframes;
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
      const std::int64_t id = first_id[d] + static_cast<std::int64_t>(k);
      graph.vertices.push_back({id, result.merged_T_body.at(d).at(k), graph.vertices.empty()});
      if (k == 0) continue;
      graph.edges.push_back({id - 1, id, keyframes[k - 1].odom_T_body.Inverse() * keyframes[k].odom_T_body, odometry});
    }
  }
  for (const merge::Overlap& overlap : result.overlaps) {
    const bool inside = std::binary_search(members.begin(), members.end(), overlap.drive_a) &&
                        std::binary_search(members.begin(), members.end(), overlap.drive_b);
    if (!overlap.accepted || !inside) continue;
    const auto body_T_level = [&](int drive, int keyframe) {
      const geom::Pose3& odom_T_body =
          DriveAt(drives, drive).keyframes.at(static_cast<std::size_t>(keyframe)).odom_T_body;
      return odom_T_body.Inverse() * geom::Level(odom_T_body);
    };
    for (const merge::Loop& loop : overlap.loops) {
      const geom::Pose3 a_T_b = body_T_level(overlap.drive_a, loop.keyframe_a) * loop.a_T_b *
                                body_T_level(overlap.drive_b, loop.keyframe_b).Inverse();
      graph.edges.push_back({first_id[static_cast<std::size_t>(overlap.drive_a)] + loop.keyframe_a,
                             first_id[static_cast<std::size_t>(overlap.drive_b)] + loop.keyframe_b, a_T_b,
                             registration * loop.weight});
    }
  }
  io::WriteG2o(path, graph);
}

void WriteMergeOutput(const fs::path& folder, const std::vector<merge::Drive>& drives, const merge::MergeResult& result,
                      const std::vector<std::vector<MapPoint>>& maps,
                      const std::vector<std::vector<io::StampedPose>>& trajectories) {
  OutputFolder output(folder);
  io::WriteFileAtomically(output.File("groups.json"), GroupsJson(drives, result));
  io::WriteFileAtomically(output.File("overlaps.json"), OverlapsJson(drives, result));
  std::vector<std::string> names;
  for (const merge::Drive& drive : drives) names.push_back(drive.name);
  const std::vector<std::string> file_names = io::UniqueFileNames(names);
  for (std::size_t g = 0; g < result.groups.size(); ++g) {
    const fs::path group = fmt::format("group_{}", g + 1);
    const io::PointCloud cloud = ColoredByDrive(maps.at(g));
    io::WritePly(output.File(group / "map.ply"), cloud);
    io::WritePcd(output.File(group / "map.pcd"), cloud);
    WritePoseGraph(output.File(group / "pose_graph.g2o"), drives, result, static_cast<int>(g));
    for (const int drive : result.groups[g]) {
      const auto d = static_cast<std::size_t>(drive);
      const bool given = d < trajectories.size() && !trajectories[d].empty();
      WriteTrajectory(file_names[d], given ? trajectories[d] : KeyframePoses(drives.at(d), result.merged_T_body.at(d)),
                      &output);
    }
  }
  output.RemoveLeftovers();
}

}  // namespace mapweld::report
