// SPDX-License-Identifier: Apache-2.0
#include "tools/io/recording_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <stdexcept>

#include "tools/io/cloud_file.hpp"
#include "tools/io/cloud_listing.hpp"
#include "tools/io/kitti.hpp"
#include "tools/io/trajectory_file.hpp"
#include "tools/io/unique_names.hpp"

namespace mapweld::io {
namespace {

namespace fs = std::filesystem;

constexpr DurationNs kMatchSlack = Milliseconds(50);  // half a turn at 10 Hz
constexpr DurationNs kAssumedPeriod = Milliseconds(100);

// A KITTI cloud of a wrong size is found before hours of work, not in the middle of them.
void CheckSizes(const std::vector<fs::path>& clouds) {
  for (const fs::path& cloud : clouds) {
    if (cloud.extension() == ".bin" && fs::file_size(cloud) % kKittiPointBytes != 0) (void)ReadKittiCloud(cloud);
  }
}

// For each scan the row of its pose.
struct Matching {
  std::vector<std::size_t> scans;
  std::vector<std::size_t> rows;
};

Matching MatchByTime(const CloudListing& listing, const std::vector<TimeNs>& scan_times, const Trajectory& trajectory,
                     std::vector<std::string>* notes) {
  Matching matching;
  const std::vector<TimeNs>& times = trajectory.times;
  for (std::size_t i = 0; i < scan_times.size(); ++i) {
    const auto after = std::lower_bound(times.begin(), times.end(), scan_times[i]) - times.begin();
    std::size_t nearest = std::min(static_cast<std::size_t>(after), times.size() - 1);
    if (nearest > 0 && scan_times[i] - times[nearest - 1] < DurationNs{std::abs((times[nearest] - scan_times[i]).ns)}) {
      --nearest;
    }
    if (std::abs((times[nearest] - scan_times[i]).ns) > kMatchSlack.ns) continue;
    matching.scans.push_back(i);
    matching.rows.push_back(nearest);
  }
  const std::size_t lost = scan_times.size() - matching.scans.size();
  if (matching.scans.size() < lost) {
    throw std::runtime_error(
        fmt::format("only {} of {} clouds in {} have a pose within {:.2f} s in {}; check that both use the same clock",
                    matching.scans.size(), scan_times.size(), listing.folder.string(), kMatchSlack.Seconds(),
                    trajectory.path.string()));
  }
  if (lost > 0) {
    notes->push_back(fmt::format("{} of {} clouds have no pose within {:.2f} s and are left out", lost,
                                 scan_times.size(), kMatchSlack.Seconds()));
  }
  return matching;
}

Matching MatchByOrder(const CloudListing& listing, const Trajectory& trajectory, std::vector<std::string>* notes) {
  const std::size_t scans = listing.files.size();
  const std::size_t poses = trajectory.world_T_lidar.size();
  Matching matching;
  for (std::size_t i = 0; i < scans; ++i) matching.scans.push_back(i);
  matching.rows = matching.scans;
  if (poses == scans) return matching;
  // A thinned recording whose frame numbers still say which row belongs to which scan.
  const bool numbered = poses > scans && !listing.numbers.empty() &&
                        static_cast<std::size_t>(listing.numbers.back()) + 1 == poses &&
                        std::adjacent_find(listing.numbers.begin(), listing.numbers.end()) == listing.numbers.end();
  if (!numbered) {
    throw std::runtime_error(fmt::format("{} has {} poses for {} clouds in {}; give one pose per cloud",
                                         trajectory.path.string(), poses, scans, listing.folder.string()));
  }
  for (std::size_t i = 0; i < scans; ++i) matching.rows[i] = static_cast<std::size_t>(listing.numbers[i]);
  notes->push_back(fmt::format("{} poses for {} clouds: the frame number in each name chooses the pose", poses, scans));
  return matching;
}

// Times of the rows when the trajectory has none of its own.
std::vector<TimeNs> RowTimes(const fs::path& recording, const CloudListing& listing, std::size_t rows,
                             std::vector<std::string>* notes) {
  std::vector<TimeNs> times;
  const fs::path path = recording / "times.txt";
  if (fs::is_regular_file(path)) {
    times = ReadKittiTimes(path);
    if (times.size() != rows) {
      throw std::runtime_error(
          fmt::format("{} has {} times for {} poses; give one time per pose", path.string(), times.size(), rows));
    }
    return times;
  }
  notes->push_back(fmt::format("no times.txt beside {}: 10 scans per second assumed", listing.folder.string()));
  for (std::size_t i = 0; i < rows; ++i) times.push_back({kAssumedPeriod.ns * static_cast<std::int64_t>(i)});
  return times;
}

void ApplyCalibration(const fs::path& recording, Trajectory* trajectory, std::vector<std::string>* notes) {
  const fs::path path = recording / "calib.txt";
  if (!trajectory->times.empty() || !fs::is_regular_file(path)) return;
  const auto camera_T_lidar = ReadKittiCalibration(path);
  if (!camera_T_lidar) {
    notes->push_back(fmt::format("{} has no line \"Tr:\": the poses are taken as those of the LiDAR", path.string()));
    return;
  }
  const geom::Pose3 lidar_T_camera = camera_T_lidar->Inverse();
  for (geom::Pose3& pose : trajectory->world_T_lidar) pose = lidar_T_camera * pose * *camera_T_lidar;
}

}  // namespace

RecordingFolder RecordingFolder::Open(const fs::path& recording) {
  const CloudListing listing = ListClouds(recording);
  CheckSizes(listing.files);
  Trajectory trajectory = ReadTrajectory(FindTrajectory(recording));

  RecordingFolder folder;
  folder.name_ = UniqueNames({recording}).front();
  ApplyCalibration(recording, &trajectory, &folder.notes_);
  Matching matching;
  std::optional<std::vector<TimeNs>> scan_times;
  if (!trajectory.times.empty()) {
    scan_times = TimesFromNames(listing, trajectory.times.front(), trajectory.times.back());
  }
  if (scan_times) {
    matching = MatchByTime(listing, *scan_times, trajectory, &folder.notes_);
  } else {
    matching = MatchByOrder(listing, trajectory, &folder.notes_);
    if (trajectory.times.empty()) {
      trajectory.times = RowTimes(recording, listing, trajectory.world_T_lidar.size(), &folder.notes_);
    }
  }
  for (std::size_t i = 0; i < matching.scans.size(); ++i) {
    const std::size_t scan = matching.scans[i];
    const std::size_t row = matching.rows[i];
    folder.clouds_.push_back(listing.files[scan]);
    folder.times_.push_back(scan_times ? (*scan_times)[scan] : trajectory.times[row]);
    folder.world_T_lidar_.push_back(trajectory.world_T_lidar[row]);
  }
  for (std::size_t i = 1; i < folder.times_.size(); ++i) {
    if (folder.times_[i] > folder.times_[i - 1]) continue;
    throw std::runtime_error(fmt::format("{} and {} have the same time; remove one of them",
                                         folder.clouds_[i - 1].string(), folder.clouds_[i].filename().string()));
  }
  return folder;
}

LoadedScan RecordingFolder::LoadScan(std::size_t i) const {
  PointCloud cloud = ReadCloud(clouds_.at(i));
  LoadedScan scan;
  scan.points = std::move(cloud.points);
  scan.dropped = std::erase_if(scan.points,
                               [](const Eigen::Vector3f& p) { return !p.allFinite() || p == Eigen::Vector3f::Zero(); });
  return scan;
}

}  // namespace mapweld::io
