// SPDX-License-Identifier: Apache-2.0
#include "tools/describe/described_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>

#include "tools/describe/variants.hpp"
#include "tools/io/recording_folder.hpp"
#include "tools/merge/parallel.hpp"
#include "tools/merge/recording.hpp"
#include "tools/serve/agent_log.hpp"

namespace mapweld::describe {
namespace {

// Called by one thread at a time.
using FindSubmap = std::function<std::shared_ptr<const merge::SubmapCloud>(int keyframe)>;

void Fill(const merge::SubmapCloud& cloud, const merge::Keyframe& keyframe, int index, submap::Submap* submap) {
  submap->keyframe = index;
  submap->t = keyframe.t;
  submap->flushed = keyframe.flushed;
  submap->points.clear();
  for (const Eigen::Vector3f& p : cloud.points) {
    if (submap->points.TryPush({p.x(), p.y(), p.z(), 1, 0}) != Status::kOk) break;
  }
}

// Appends one description per keyframe and variant to `rows`, which hold scans and positions.
void DescribeKeyframes(const merge::Drive& drive, const FindSubmap& find, const std::vector<std::string>& variants,
                       int threads, merge::Progress* progress, DescribedDrive* out) {
  const int count = static_cast<int>(drive.keyframes.size());
  const int jobs = std::min(count, 4 * merge::ThreadCount(threads));
  std::mutex mutex;
  int done = 0;
  merge::ParallelFor(jobs, threads, [&](int job) {
    std::vector<std::unique_ptr<PlaceMethod>> methods;
    for (const std::string& name : variants) methods.push_back(name == kPublished ? nullptr : MakeVariant(name));
    const auto submap = std::make_unique<submap::Submap>();
    for (int k = job; k < count; k += jobs) {
      const auto i = static_cast<std::size_t>(k);
      std::shared_ptr<const merge::SubmapCloud> cloud;
      {
        const std::lock_guard lock(mutex);
        cloud = find(k);
        if (progress != nullptr) progress->Report("descriptors", ++done, count);
      }
      if (cloud != nullptr) Fill(*cloud, drive.keyframes[i], k, submap.get());
      for (std::size_t v = 0; v < variants.size(); ++v) {
        place::PlaceDescription* const place = &out->variants[v][i].place;
        if (methods[v] == nullptr) {
          *place = drive.keyframes[i].place;
        } else if (cloud == nullptr || methods[v]->Describe(*submap, place) != Status::kOk) {
          *place = {};
        }
      }
    }
  });
  for (const std::vector<PlaceRow>& rows : out->variants) {
    out->refused.push_back(static_cast<int>(
        std::count_if(rows.begin(), rows.end(), [](const PlaceRow& row) { return row.place.descriptor.scale <= 0; })));
  }
}

DescribedDrive WithPositions(const merge::Drive& drive, const geom::Pose3& world_T_odom,
                             const std::vector<TimeNs>& scan_times, std::size_t variants) {
  DescribedDrive out;
  out.name = drive.name;
  std::vector<PlaceRow> rows;
  for (const merge::Keyframe& keyframe : drive.keyframes) {
    PlaceRow row;
    const auto scan = std::lower_bound(scan_times.begin(), scan_times.end(), keyframe.t);
    row.scan = scan_times.empty() ? static_cast<int>(rows.size()) : static_cast<int>(scan - scan_times.begin());
    row.position = world_T_odom * keyframe.odom_T_body.t;
    rows.push_back(row);
    out.times.push_back(keyframe.t);
  }
  out.variants.assign(variants, rows);
  return out;
}

DescribedDrive DescribeFolder(const std::filesystem::path& path, const std::vector<std::string>& variants, int threads,
                              merge::Progress* progress) {
  const io::RecordingFolder folder = io::RecordingFolder::Open(path);
  for (const std::string& note : folder.notes()) fmt::print(stderr, "note: {}\n", note);
  const merge::Recording recording{folder.name(), folder.times(), folder.world_T_lidar(), [&folder](int scan) {
                                     return folder.LoadScan(static_cast<std::size_t>(scan)).points;
                                   }};
  merge::RecordingConfig config;
  config.threads = threads;
  const merge::RecordedDrive recorded = merge::BuildDrive(recording, config, progress);
  DescribedDrive out = WithPositions(recorded.drive, recorded.odom_T_world.Inverse(), recording.times, variants.size());
  const FindSubmap find = [&](int k) { return merge::Kept(&recorded.submaps[static_cast<std::size_t>(k)]); };
  DescribeKeyframes(recorded.drive, find, variants, threads, progress, &out);
  return out;
}

std::vector<DescribedDrive> DescribeLog(const std::filesystem::path& path, const std::vector<std::string>& variants,
                                        int threads, merge::Progress* progress) {
  serve::AgentLog log(path);
  if (log.refused() > 0) fmt::print(stderr, "note: {}: {} broken messages passed over\n", path.string(), log.refused());
  const bool needs_submaps = variants != std::vector<std::string>{kPublished};
  std::vector<DescribedDrive> out;
  for (std::size_t d = 0; d < log.drives().size(); ++d) {
    const merge::Drive& drive = log.drives()[d];
    out.push_back(WithPositions(drive, geom::Pose3{}, {}, variants.size()));
    const FindSubmap find = [&](int k) -> std::shared_ptr<const merge::SubmapCloud> {
      return needs_submaps ? log.Submap(d, k) : nullptr;
    };
    DescribeKeyframes(drive, find, variants, threads, progress, &out.back());
  }
  return out;
}

}  // namespace

std::vector<DescribedDrive> DescribeDrives(const std::filesystem::path& path, const std::vector<std::string>& variants,
                                           int threads, merge::Progress* progress) {
  const bool is_log = path.extension() == ".lcm";
  for (const std::string& name : variants) {
    if (name != kPublished) MakeVariant(name);
    if (name == kPublished && !is_log) {
      throw std::runtime_error(fmt::format("{} is no LCM log, so nothing is published in it; choose a descriptor: {}",
                                           path.string(), VariantList()));
    }
  }
  if (is_log) return DescribeLog(path, variants, threads, progress);
  std::vector<DescribedDrive> out;
  out.push_back(DescribeFolder(path, variants, threads, progress));
  return out;
}

}  // namespace mapweld::describe
