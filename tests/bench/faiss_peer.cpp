// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/bench_tools.hpp"

#if __has_include(<faiss/IndexFlat.h>)
#include <faiss/IndexFlat.h>
#include <faiss/IndexIVFFlat.h>
#include <faiss/IndexLSH.h>
#include <fmt/format.h>
#include <omp.h>

namespace mapweld::bench {
namespace {

constexpr int kNeighbours = 16;

// Queries with another drive within 4 m that have one within 10 m among their neighbours.
double PlaceRecall(const std::vector<merge::Drive>& drives, const std::vector<std::int64_t>& found) {
  std::vector<const merge::Keyframe*> all;
  std::vector<std::size_t> drive_of;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    for (const merge::Keyframe& keyframe : drives[d].keyframes) {
      all.push_back(&keyframe);
      drive_of.push_back(d);
    }
  }
  int queries = 0;
  int hits = 0;
  for (std::size_t q = 0; q < all.size(); q += 7) {
    const auto within = [&](std::size_t k, double distance_m) {
      return drive_of[k] != drive_of[q] && (all[k]->odom_T_body.t - all[q]->odom_T_body.t).norm() < distance_m;
    };
    bool meets = false;
    for (std::size_t k = 0; k < all.size() && !meets; ++k) meets = within(k, 4);
    if (!meets) continue;
    ++queries;
    for (std::size_t i = 0; i < kNeighbours; ++i) {
      const std::int64_t k = found[q * kNeighbours + i];
      if (k < 0 || !within(static_cast<std::size_t>(k), 10)) continue;
      ++hits;
      break;
    }
  }
  return queries > 0 ? 100.0 * hits / queries : 0;
}

}  // namespace

std::vector<PeerResult> MeasurePeers(const std::vector<merge::Drive>& drives) {
  omp_set_num_threads(1);
  std::vector<float> rows;
  for (const merge::Drive& drive : drives) {
    for (const merge::Keyframe& keyframe : drive.keyframes) {
      for (const std::int8_t q : keyframe.place.descriptor.q) {
        rows.push_back(static_cast<float>(q) * keyframe.place.descriptor.scale);
      }
    }
  }
  const auto n = static_cast<std::int64_t>(rows.size() / place::kDescriptorDim);
  std::vector<float> distances(static_cast<std::size_t>(n * kNeighbours));
  std::vector<std::int64_t> found(static_cast<std::size_t>(n * kNeighbours));
  std::vector<PeerResult> out;
  const auto measure = [&](const std::string& name, faiss::Index* index, double build_s) {
    const double begin_s = CpuSeconds();
    index->search(n, rows.data(), kNeighbours, distances.data(), found.data());
    const double search_s = CpuSeconds() - begin_s;
    out.push_back({"FAISS " + name + ", search", search_s,
                   fmt::format("build {:.2f} s, place recall@16 {:.1f} %", build_s, PlaceRecall(drives, found))});
  };
  {
    faiss::IndexFlatIP flat(place::kDescriptorDim);
    flat.add(n, rows.data());
    measure("IndexFlatIP, k = 16", &flat, 0);
  }
  {
    const double begin_s = CpuSeconds();
    faiss::IndexLSH lsh(place::kDescriptorDim, 256, true, true);
    lsh.train(n, rows.data());
    lsh.add(n, rows.data());
    measure("IndexLSH, 256 bits", &lsh, CpuSeconds() - begin_s);
  }
  {
    const double begin_s = CpuSeconds();
    faiss::IndexFlatIP quantizer(place::kDescriptorDim);
    faiss::IndexIVFFlat ivf(&quantizer, place::kDescriptorDim, 256, faiss::METRIC_INNER_PRODUCT);
    ivf.train(n, rows.data());
    ivf.add(n, rows.data());
    const double build_s = CpuSeconds() - begin_s;
    ivf.nprobe = 1;
    measure("IVF256,Flat, nprobe 1", &ivf, build_s);
  }
  return out;
}

}  // namespace mapweld::bench
#else
namespace mapweld::bench {
std::vector<PeerResult> MeasurePeers(const std::vector<merge::Drive>& /*drives*/) {
  return {};
}
}  // namespace mapweld::bench
#endif
