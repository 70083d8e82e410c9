// SPDX-License-Identifier: Apache-2.0
// How groups grow while drives arrive in random order (Fig. 12 of the AutoMerge paper, doi 10.1109/TRO.2023.3290448).
// Which pairs overlap does not depend on the order, so the decisions of one merge are taken, and after every arrival
// the drives that are there are grouped anew.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace mapweld::eval {

struct WeighedOverlap {
  int first = 0;  // index of the drive
  int second = 0;
  double length_m = 0;
  double weight = 0;  // omega of eq. 9 as the merge computed it
};

struct MergedDrives {
  std::vector<std::string> names;        // sorted
  std::vector<WeighedOverlap> overlaps;  // the accepted ones
};

// From groups.json and overlaps.json of a merge. Throws std::runtime_error naming the file.
MergedDrives ReadMergedDrives(const std::filesystem::path& folder);

// Over all orders, with the same number of drives there.
struct ArrivalStep {
  double mean_groups = 0;
  int fewest_groups = 0;
  int most_groups = 0;
  int mixed_groups = 0;  // in all orders together: groups with drives of two zones
};

struct ArrivalStudy {
  double half_weight_m = 0;        // shared length that makes omega 1/2: the paper's C_omega
  std::vector<ArrivalStep> steps;  // after 1, 2, ... arrivals
  int outcomes = 0;                // different groupings at the end; 1: the order does not matter
};

// `zones` per drive (any numbers; equal: connected in truth), or empty: then nothing is called mixed. Cost: one
// eigenvalue problem per arrival and order.
ArrivalStudy StudyArrivals(const MergedDrives& drives, const std::vector<int>& zones, double half_weight_m, int orders,
                           std::uint32_t seed);

// omega for another half weight, from that for `from_m`: exp((C_from - C_to) / (2 L^2 + 1e-4)) times as much.
double Reweighed(const WeighedOverlap& overlap, double from_m, double to_m);

}  // namespace mapweld::eval
