// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/viewpoint_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <numbers>
#include <stdexcept>

#include "tools/describe/described_drive.hpp"
#include "tools/describe/variants.hpp"
#include "tools/eval/place_set.hpp"
#include "tools/merge/parallel.hpp"
#include "tools/merge/voxel_mean.hpp"

namespace mapweld::eval {
namespace {

using describe::KeyframeSource;
using describe::PlaceMethod;
constexpr double kVoxel_m = 0.5;
constexpr double kHit_m = 10;
constexpr std::size_t kViews = kSweepYaws_deg.size() * kSweepLefts_m.size();

// Left of the direction of travel, in the level frame of the keyframe: sensors may look anywhere.
Eigen::Vector2f LeftInLevel(const KeyframeSource& source, std::size_t k) {
  const auto& keyframes = source.drive.keyframes;
  const geom::Vec3d travel =
      keyframes[std::min(k + 1, keyframes.size() - 1)].odom_T_body.t - keyframes[k > 0 ? k - 1 : 0].odom_T_body.t;
  const geom::Vec3d level = geom::Level(keyframes[k].odom_T_body).q.inverse() * travel;
  return Eigen::Vector2f(static_cast<float>(-level.y()), static_cast<float>(level.x())).stableNormalized();
}

class Sweep {
 public:
  Sweep(const std::vector<KeyframeSource>& sources, const SweepConfig& config, merge::Progress* progress)
      : sources_(&sources), config_(&config), progress_(progress) {
    for (std::size_t s = 0; s < sources.size(); ++s) {
      set_.AddSession(sources[s].drive.name, sources[s].positions);
      for (std::size_t k = 0; k < sources[s].positions.size(); ++k) places_.push_back({s, k});
    }
    FindQueries();
    for (const std::string& name : config.variants) comparers_.push_back(describe::MakeVariant(name));
    database_.assign(config.variants.size(), std::vector<PlaceMethod::Features>(places_.size()));
  }

  std::vector<SweepScore> Run() {
    if (queries_.empty()) throw std::runtime_error("no place is visited twice here, so there is nothing to recognise");
    ForAll("keyframes", places_.size(), [&](std::size_t i, Worker* worker) {
      const auto cloud = Cloud(i);
      if (cloud == nullptr) return;
      worker->Fill(SeenFrom(*cloud, Eigen::Vector2f::Zero(), 0));
      for (std::size_t v = 0; v < comparers_.size(); ++v) database_[v][i] = worker->Describe(v);
    });
    std::vector<std::vector<std::array<bool, kViews>>> hit(
        comparers_.size(), std::vector<std::array<bool, kViews>>(queries_.size(), std::array<bool, kViews>{}));
    ForAll("views", queries_.size(), [&](std::size_t q, Worker* worker) { Ask(q, worker, &hit); });
    return Count(hit);
  }

 private:
  struct PlaceIndex {
    std::size_t source;
    std::size_t keyframe;
  };

  // One per thread: the describers have scratch memory.
  class Worker {
   public:
    explicit Worker(const std::vector<std::string>& variants) {
      for (const std::string& name : variants) methods_.push_back(describe::MakeVariant(name));
    }
    void Fill(const std::vector<Eigen::Vector3f>& points) { describe::FillSubmap(points, submap_.get()); }
    // Empty when the submap cannot be described.
    PlaceMethod::Features Describe(std::size_t variant) {
      place::PlaceDescription place;
      if (methods_[variant]->Describe(*submap_, &place) != Status::kOk) return {};
      return methods_[variant]->Prepare(place);
    }

   private:
    std::vector<std::unique_ptr<PlaceMethod>> methods_;
    std::unique_ptr<submap::Submap> submap_ = std::make_unique<submap::Submap>();
  };

  void FindQueries() {
    std::vector<int> all;
    for (int i = 0; i < set_.size(); ++i) {
      for (int j = 0; j < set_.size(); ++j) {
        if (!set_.IsCandidate(i, j) || set_.Metres(i, j) > kHit_m) continue;
        all.push_back(i);
        break;
      }
    }
    const std::size_t most = static_cast<std::size_t>(std::max(config_->most_queries, 1));
    const std::size_t used = std::min(most, all.size());
    for (std::size_t q = 0; q < used; ++q) queries_.push_back(all[q * all.size() / used]);
  }

  std::shared_ptr<const merge::SubmapCloud> Cloud(std::size_t i) {
    const std::lock_guard lock(mutex_);
    return (*sources_)[places_[i].source].submap(static_cast<int>(places_[i].keyframe));
  }

  template <class Job>
  void ForAll(std::string_view stage, std::size_t count, const Job& job) {
    const auto jobs = std::min(count, static_cast<std::size_t>(8 * merge::ThreadCount(config_->threads)));
    std::size_t done = 0;
    merge::ParallelFor(static_cast<int>(jobs), config_->threads, [&](int first) {
      Worker worker(config_->variants);
      for (auto i = static_cast<std::size_t>(first); i < count; i += jobs) {
        job(i, &worker);
        const std::lock_guard lock(mutex_);
        if (progress_ != nullptr) progress_->Report(stage, static_cast<int>(++done), static_cast<int>(count));
      }
    });
  }

  void Ask(std::size_t q, Worker* worker, std::vector<std::vector<std::array<bool, kViews>>>* hit) {
    const int query = queries_[q];
    const PlaceIndex at = places_[static_cast<std::size_t>(query)];
    const auto cloud = Cloud(static_cast<std::size_t>(query));
    if (cloud == nullptr) return;
    const Eigen::Vector2f left = LeftInLevel((*sources_)[at.source], at.keyframe);
    for (std::size_t view = 0; view < kViews; ++view) {
      const double yaw_rad = kSweepYaws_deg[view / kSweepLefts_m.size()] * std::numbers::pi / 180;
      const double left_m = kSweepLefts_m[view % kSweepLefts_m.size()];
      worker->Fill(SeenFrom(*cloud, left * static_cast<float>(left_m), yaw_rad));
      for (std::size_t v = 0; v < comparers_.size(); ++v) {
        const int best = Nearest(query, v, worker->Describe(v));
        (*hit)[v][q][view] = best >= 0 && (set_.LeftOf(query, left_m) - set_.Position(best)).norm() <= kHit_m;
      }
    }
  }

  [[nodiscard]] int Nearest(int query, std::size_t variant, const PlaceMethod::Features& features) const {
    if (features.empty()) return -1;
    int best = -1;
    float nearest = std::numeric_limits<float>::infinity();
    for (int j = 0; j < set_.size(); ++j) {
      const PlaceMethod::Features& candidate = database_[variant][static_cast<std::size_t>(j)];
      if (candidate.empty() || !set_.IsCandidate(query, j)) continue;
      const float distance = comparers_[variant]->Distance(features, candidate);
      if (distance < nearest) best = j;
      nearest = std::min(nearest, distance);
    }
    return best;
  }

  [[nodiscard]] std::vector<SweepScore> Count(const std::vector<std::vector<std::array<bool, kViews>>>& hit) const {
    std::vector<SweepScore> scores;
    for (std::size_t v = 0; v < comparers_.size(); ++v) {
      SweepScore score{config_->variants[v], static_cast<int>(queries_.size()), {}};
      for (std::size_t view = 0; view < kViews; ++view) {
        const auto hits = std::count_if(hit[v].begin(), hit[v].end(), [&](const auto& q) { return q[view]; });
        score.recall[view / kSweepLefts_m.size()][view % kSweepLefts_m.size()] =
            static_cast<double>(hits) / static_cast<double>(queries_.size());
      }
      scores.push_back(score);
    }
    return scores;
  }

  const std::vector<KeyframeSource>* sources_;
  const SweepConfig* config_;
  merge::Progress* progress_;
  PlaceSet set_;
  std::vector<PlaceIndex> places_;
  std::vector<int> queries_;
  std::vector<std::unique_ptr<PlaceMethod>> comparers_;
  std::vector<std::vector<PlaceMethod::Features>> database_;  // [variant][place]
  std::mutex mutex_;
};

}  // namespace

std::vector<Eigen::Vector3f> SeenFrom(const merge::SubmapCloud& cloud, const Eigen::Vector2f& left, double yaw_rad) {
  merge::VoxelMean voxels(kVoxel_m);
  const Eigen::Matrix2f turn = Eigen::Rotation2Df(static_cast<float>(-yaw_rad)).toRotationMatrix();
  constexpr auto kRadius = static_cast<float>(describe::kSubmapRadius_m);
  for (const Eigen::Vector3f& p : cloud.points) {
    Eigen::Vector3f seen = p;
    seen.head<2>() = turn * (p.head<2>() - left);
    if (seen.head<2>().squaredNorm() <= kRadius * kRadius) voxels.Add(seen, 1);
  }
  std::vector<merge::WeightedPoint> means;
  voxels.Take(&means);
  std::vector<Eigen::Vector3f> points;
  for (const merge::WeightedPoint& mean : means) points.push_back(mean.p);
  return points;
}

std::vector<SweepScore> SweepViewpoints(const std::vector<KeyframeSource>& sources, const SweepConfig& config,
                                        merge::Progress* progress) {
  return Sweep(sources, config, progress).Run();
}

}  // namespace mapweld::eval
