// SPDX-License-Identifier: Apache-2.0
// How long association takes, stage by stage, on made-up descriptors of a city; beside the machine's ceiling for exact
// int8 products and, where it is installed, FAISS. CPU seconds of one thread.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/bench/bench_tools.hpp"
#include "tests/support/city_descriptors.hpp"
#include "tools/merge/association.hpp"
#include "tools/merge/cosine_kernel.hpp"
#include "tools/merge/line_sums.hpp"

namespace mapweld::bench {
namespace {

using merge::Drive;
using merge::DrivePlaces;
using merge::KeyframeRange;
using merge::Likeness;
using merge::LineSums;

constexpr int kPerDrive = 480;
constexpr int kDim = place::kDescriptorDim;

class Table {
 public:
  void Row(const std::string& what, double seconds, const std::string& remark) {
    rows_.push_back({{"what", what}, {"cpu_s", seconds}, {"remark", remark}});
    if (!json_) fmt::print("{:<58} {:>9.3f} s   {}\n", what, seconds, remark);
    std::fflush(stdout);
  }
  void UseJson() { json_ = true; }
  void Finish() const {
    if (json_) fmt::print("{}\n", rows_.dump(2));
  }

 private:
  bool json_ = false;
  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

struct City {
  std::vector<Drive> drives;
  std::vector<DrivePlaces> places;
  [[nodiscard]] double Cells() const {
    double cells = 0;
    for (std::size_t a = 0; a < drives.size(); ++a) {
      for (std::size_t b = a + 1; b < drives.size(); ++b) {
        cells += static_cast<double>(drives[a].keyframes.size()) * static_cast<double>(drives[b].keyframes.size());
      }
    }
    return cells;
  }
};

double DistanceBetween(const Drive& a, int i, const Drive& b, int k) {
  return (a.keyframes[static_cast<std::size_t>(i)].odom_T_body.t -
          b.keyframes[static_cast<std::size_t>(k)].odom_T_body.t)
      .norm();
}

// Every 7th keyframe of a at which b passes within 4 m: is the best line of 20 keyframes around it within 12 m?
struct Hits {
  int found = 0;
  int all = 0;
};
Hits CountHits(const Drive& a, const Drive& b, const Likeness& likeness, bool counts) {
  constexpr int kLength = 20;
  Hits hits;
  LineSums forward(likeness.cols, kLength, 1, false);
  LineSums backward(likeness.cols, kLength, 1, true);
  for (int row = 0; row < likeness.rows; ++row) {
    forward.Add(likeness.row(row));
    backward.Add(likeness.row(row));
    if (row % 7 != 0 || row < kLength) continue;
    const int middle = row - kLength / 2;
    bool meets = false;
    for (int k = kLength; k < likeness.cols - kLength && !meets; ++k) meets = DistanceBetween(a, middle, b, k) < 4;
    if (!meets) continue;
    ++hits.all;
    const auto best_of = [](const LineSums& lines) {
      return static_cast<int>(std::min_element(lines.least().begin(), lines.least().end()) - lines.least().begin());
    };
    const int f = best_of(forward);
    const int r = best_of(backward);
    const bool is_forward =
        forward.least()[static_cast<std::size_t>(f)] <= backward.least()[static_cast<std::size_t>(r)];
    const int at = std::clamp(is_forward ? f - kLength / 2 : r + kLength / 2, 0, likeness.cols - 1);
    if (counts && DistanceBetween(a, middle, b, at) < 12) ++hits.found;
  }
  return hits;
}

// The same least sums, each added up on its own.
double DirectSeconds(const Likeness& likeness, int length, bool* equal) {
  double seconds = 0;
  *equal = true;
  for (const bool reverse : {false, true}) {
    std::vector<std::vector<std::uint16_t>> direct;
    LineSums lines(likeness.cols, length, 1, reverse);
    const double begin_s = CpuSeconds();
    for (int row = 0; row < likeness.rows; ++row) {
      std::vector<std::uint16_t> least(static_cast<std::size_t>(likeness.cols), LineSums::kNoLine);
      for (int speed = 0; speed < static_cast<int>(merge::kLineSpeeds.size()) && row >= length - 1; ++speed) {
        for (int col = 0; col < likeness.cols; ++col) {
          const int base = col - lines.Shift(speed, row);
          const int first = base + lines.Shift(speed, row - length + 1);
          if (first < 0 || first >= likeness.cols) continue;
          int sum = 0;
          for (int r = row - length + 1; r <= row; ++r) sum += likeness.row(r)[base + lines.Shift(speed, r)];
          least[static_cast<std::size_t>(col)] =
              std::min(least[static_cast<std::size_t>(col)], static_cast<std::uint16_t>(sum));
        }
      }
      direct.push_back(std::move(least));
    }
    seconds += CpuSeconds() - begin_s;
    for (int row = 0; row < likeness.rows; ++row) {
      lines.Add(likeness.row(row));
      const auto& expected = direct[static_cast<std::size_t>(row)];
      *equal = *equal && std::equal(expected.begin(), expected.end(), lines.least().begin());
    }
  }
  return seconds;
}

double SequenceSeconds(const Likeness& likeness, int length) {
  const double begin_s = CpuSeconds();
  for (const bool reverse : {false, true}) {
    LineSums lines(likeness.cols, length, 1, reverse);
    for (int row = 0; row < likeness.rows; ++row) lines.Add(likeness.row(row));
  }
  return CpuSeconds() - begin_s;
}

void MeasureKernels(const City& city, Table* table) {
  const merge::DescriptorSet& a = city.places[0].descriptors;
  const merge::DescriptorSet& b = city.places[1].descriptors;
  std::vector<std::int16_t> out(static_cast<std::size_t>(a.count) * static_cast<std::size_t>(b.count));
  const double ops = 2.0 * a.count * b.count * kDim;
  for (const merge::CosineKernel& kernel : merge::CosineKernels()) {
    std::vector<double> seconds;
    std::vector<double> shares;
    const bool is_plain = std::string(kernel.name) == "portable";
    for (int i = 0; i < (is_plain ? 3 : 15); ++i) {
      const double ceiling = is_plain ? 0 : CeilingOpsPerSecond(kernel.name);
      const double begin_s = CpuSeconds();
      const int times = is_plain ? 1 : 10;
      for (int k = 0; k < times; ++k) {
        kernel.compute(a, {0, a.count}, b, {0, b.count}, out.data(), static_cast<std::size_t>(b.count));
      }
      seconds.push_back((CpuSeconds() - begin_s) / times);
      if (!is_plain) shares.push_back(ops / seconds.back() / ceiling);
    }
    const double median_s = Median(seconds);
    const std::string remark =
        is_plain ? "" : fmt::format(", {:.0f} % of the ceiling in the same run", 100 * Median(shares));
    table->Row(fmt::format("one difference block {} x {}, {}", a.count, b.count, kernel.name), median_s,
               fmt::format("{:.0f} GOP/s{}", ops / median_s * 1e-9, remark));
  }
}

// Difference, likeness and sequences of all pairs, and the hits.
Hits MeasureExact(const City& city, bool with_hits, Table* table) {
  double cosine_s = 0;
  double likeness_s = 0;
  std::vector<int> lengths = {10, 20, 50, 100};
  std::vector<double> sequence_s(lengths.size(), 0);
  Hits hits;
  for (std::size_t a = 0; a < city.drives.size(); ++a) {
    for (std::size_t b = a + 1; b < city.drives.size(); ++b) {
      double begin_s = CpuSeconds();
      const merge::Cosines cosines = merge::ComputeCosines(city.places[a].descriptors, city.places[b].descriptors);
      cosine_s += CpuSeconds() - begin_s;
      begin_s = CpuSeconds();
      const Likeness likeness = ComputeLikeness(cosines);
      likeness_s += CpuSeconds() - begin_s;
      for (std::size_t i = 0; i < lengths.size(); ++i) sequence_s[i] += SequenceSeconds(likeness, lengths[i]);
      if (!with_hits) continue;
      const Hits of_pair = CountHits(city.drives[a], city.drives[b], likeness, true);
      hits.found += of_pair.found;
      hits.all += of_pair.all;
    }
  }
  const double ops = 2 * city.Cells() * kDim;
  table->Row("difference blocks of all pairs, exact", cosine_s, fmt::format("{:.0f} GOP/s", ops / cosine_s * 1e-9));
  table->Row("likeness of all pairs", likeness_s, "");
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    table->Row(fmt::format("sequences of {} keyframes, 5 speeds, 2 directions", lengths[i]), sequence_s[i],
               fmt::format("{:.1f} G cell-speeds/s", 10 * city.Cells() / sequence_s[i] * 1e-9));
  }
  const Likeness likeness =
      ComputeLikeness(merge::ComputeCosines(city.places[0].descriptors, city.places[1].descriptors));
  for (const int length : {20, 100}) {
    bool equal = false;
    const double direct_s = DirectSeconds(likeness, length, &equal);
    const double own_s = SequenceSeconds(likeness, length);
    table->Row(fmt::format("direct sums of {} keyframes, one block", length), direct_s,
               fmt::format("bits {}; running sums {:.0f} times faster", equal ? "equal" : "DIFFER", direct_s / own_s));
  }
  return hits;
}

// The way the merge does it.
void MeasureSelected(const City& city, const Hits& exact, bool with_hits, Table* table) {
  const merge::AssociationConfig config;
  double begin_s = CpuSeconds();
  for (const Drive& drive : city.drives) (void)merge::CollectPlaces(drive);
  const double collect_s = CpuSeconds() - begin_s;
  double sketch_s = 0;
  double full_s = 0;
  int compared = 0;
  std::size_t matches = 0;
  Hits hits;
  for (std::size_t a = 0; a < city.drives.size(); ++a) {
    for (std::size_t b = a + 1; b < city.drives.size(); ++b) {
      begin_s = CpuSeconds();
      merge::Evidence evidence;
      const bool agrees = SketchesAgree(city.places[a], city.places[b], config, &evidence);
      sketch_s += CpuSeconds() - begin_s;
      begin_s = CpuSeconds();
      if (agrees) {
        ++compared;
        const merge::Cosines cosines = merge::ComputeCosines(city.places[a].descriptors, city.places[b].descriptors);
        matches += ProposeMatches(ComputeLikeness(cosines), config).size();
      }
      full_s += CpuSeconds() - begin_s;
      if (!with_hits) continue;
      const Hits of_pair = CountHits(
          city.drives[a], city.drives[b],
          ComputeLikeness(merge::ComputeCosines(city.places[a].descriptors, city.places[b].descriptors)), agrees);
      hits.found += of_pair.found;
      hits.all += of_pair.all;
    }
  }
  const std::size_t pairs = city.drives.size() * (city.drives.size() - 1) / 2;
  table->Row("collect descriptors, make sketches", collect_s, "");
  table->Row("sketches of all pairs", sketch_s, fmt::format("{} of {} pairs are compared in full", compared, pairs));
  table->Row("full comparison of those, matches", full_s, fmt::format("{} matches", matches));
  table->Row(
      "association with pre-selection, all", collect_s + sketch_s + full_s,
      with_hits ? fmt::format("hits {} of {}, exact {} of {}", hits.found, hits.all, exact.found, exact.all) : "");
}

void MeasureNewDrive(const City& city, Table* table) {
  std::vector<double> seconds;
  const std::size_t last = city.drives.size() - 1;
  for (int i = 0; i < 5; ++i) {
    const double begin_s = CpuSeconds();
    const DrivePlaces places = merge::CollectPlaces(city.drives[last]);
    for (std::size_t a = 0; a < last; ++a) (void)merge::Associate(city.places[a], places, {});
    seconds.push_back(CpuSeconds() - begin_s);
  }
  table->Row(fmt::format("one more drive of {} keyframes", kPerDrive), Median(seconds), "exact");
}

struct Wanted {
  int keyframes = 24000;
  bool exact = true;
  bool peers = false;
  bool new_drive_only = false;
};

void Run(const Wanted& wanted, Table* table) {
  test::CityDescriptorsConfig config;
  config.drives = std::max(2, wanted.keyframes / kPerDrive);
  config.keyframes = kPerDrive;
  // As many streets per drive as 50 drives have in 6 x 6 km.
  config.blocks = static_cast<int>(60 * std::sqrt(config.drives / 50.0) + 0.5);
  City city;
  city.drives = test::CityDescriptors(config).Make();
  for (const Drive& drive : city.drives) city.places.push_back(merge::CollectPlaces(drive));
  MeasureKernels(city, table);
  Hits hits;
  if (wanted.exact && !wanted.new_drive_only) hits = MeasureExact(city, true, table);
  if (!wanted.new_drive_only) MeasureSelected(city, hits, wanted.exact, table);
  MeasureNewDrive(city, table);
  if (wanted.peers) {
    for (const PeerResult& peer : MeasurePeers(city.drives)) table->Row(peer.what, peer.cpu_s, peer.remark);
  }
}

}  // namespace
}  // namespace mapweld::bench

int main(int argc, char** argv) {
  CLI::App app("Association of made-up descriptors, stage by stage: CPU seconds of one thread");
  mapweld::bench::Wanted wanted;
  bool json = false;
  bool skip_exact = false;
  app.add_option("--keyframes", wanted.keyframes, "of all drives together, 480 each")->check(CLI::Range(960, 10000000));
  app.add_flag("--json", json, "for programs");
  app.add_flag("--skip-exact", skip_exact, "only the way the merge does it");
  app.add_flag("--new-drive", wanted.new_drive_only, "only what one more drive costs");
  app.add_flag("--peers", wanted.peers, "also FAISS, when this was built with it");
  CLI11_PARSE(app, argc, argv);
  wanted.exact = !skip_exact;
  mapweld::bench::Table table;
  if (json) table.UseJson();
  mapweld::bench::Run(wanted, &table);
  table.Finish();
  return 0;
}
