// SPDX-License-Identifier: Apache-2.0
#include "tools/describe/described_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <stdexcept>

#include "tools/describe/keyframe_source.hpp"
#include "tools/describe/variants.hpp"
#include "tools/merge/parallel.hpp"

namespace mapweld::describe {
namespace {

// Rows with scans and positions, one list per variant, without descriptions.
DescribedDrive Undescribed(const KeyframeSource& source, std::size_t variants) {
  DescribedDrive out;
  out.name = source.drive.name;
  std::vector<PlaceRow> rows;
  for (std::size_t i = 0; i < source.positions.size(); ++i) {
    rows.push_back({source.scans[i], source.positions[i], {}});
  }
  out.variants.assign(variants, rows);
  return out;
}

}  // namespace

DescribedDrive DescribeKeyframes(const KeyframeSource& source, const std::vector<std::string>& variants, int threads,
                                 merge::Progress* progress) {
  DescribedDrive out = Undescribed(source, variants.size());
  const bool needs_submaps = variants != std::vector<std::string>{kPublished};
  const int count = static_cast<int>(source.positions.size());
  const int jobs = std::min(count, 4 * merge::ThreadCount(threads));
  std::mutex mutex;
  int done = 0;
  out.unfamiliar.assign(variants.size(), 0);
  merge::ParallelFor(jobs, threads, [&](int job) {
    std::vector<std::unique_ptr<PlaceMethod>> methods;
    for (const std::string& name : variants) methods.push_back(name == kPublished ? nullptr : MakeVariant(name));
    const auto submap = std::make_unique<submap::Submap>();
    for (int k = job; k < count; k += jobs) {
      const auto i = static_cast<std::size_t>(k);
      const merge::Keyframe& keyframe = source.drive.keyframes[i];
      std::shared_ptr<const merge::SubmapCloud> cloud;
      {
        const std::lock_guard lock(mutex);
        if (needs_submaps) cloud = source.submap(k);
        if (progress != nullptr) progress->Report("descriptors", ++done, count);
      }
      if (cloud != nullptr) FillSubmap(cloud->points, submap.get());
      for (std::size_t v = 0; v < variants.size(); ++v) {
        place::PlaceDescription* const place = &out.variants[v][i].place;
        if (methods[v] == nullptr) {
          *place = keyframe.place;
        } else if (cloud == nullptr || methods[v]->Describe(*submap, place) != Status::kOk) {
          *place = {};
        } else if (methods[v]->IsUnfamiliar()) {
          const std::lock_guard lock(mutex);
          ++out.unfamiliar[v];
        }
      }
    }
  });
  for (const std::vector<PlaceRow>& rows : out.variants) {
    out.refused.push_back(static_cast<int>(
        std::count_if(rows.begin(), rows.end(), [](const PlaceRow& row) { return row.place.descriptor.scale <= 0; })));
  }
  return out;
}

void FillSubmap(const std::vector<Eigen::Vector3f>& points, submap::Submap* submap) {
  submap->points.clear();
  for (const Eigen::Vector3f& p : points) {
    if (submap->points.TryPush({p.x(), p.y(), p.z(), 1, 0}) != Status::kOk) break;
  }
}

void CheckVariants(const std::filesystem::path& input, const std::vector<std::string>& variants) {
  for (const std::string& name : variants) {
    if (name == kPublished && input.extension() != ".lcm") {
      throw std::runtime_error(fmt::format("{} is no LCM log, so nothing is published in it; choose a descriptor: {}",
                                           input.string(), VariantList()));
    }
    if (name != kPublished) MakeVariant(name);
  }
}

}  // namespace mapweld::describe
