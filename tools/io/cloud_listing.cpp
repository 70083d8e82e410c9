// SPDX-License-Identifier: Apache-2.0
#include "tools/io/cloud_listing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "tools/io/cloud_file.hpp"
#include "tools/io/text_rows.hpp"

namespace mapweld::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSubfolders[] = {"velodyne", "clouds", "scans",  "lidar", "points",
                                            "pcd",      "pcds",   "frames", "ply",   "velodyne_points/data"};
// Shorter whole numbers are frame numbers; ten digits are seconds since 1970.
constexpr std::size_t kStampDigits = 10;

bool AllDigits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// "1326030975.736588", "1673400472138016708" or "1673400472_138016708" (seconds, nanoseconds). Empty for other names.
std::string StampOf(const std::string& stem) {
  const std::size_t mark = stem.find_first_of("._");
  if (mark == std::string::npos) return AllDigits(stem) && stem.size() >= kStampDigits ? stem : "";
  const std::string head = stem.substr(0, mark);
  const std::string tail = stem.substr(mark + 1);
  if (!AllDigits(head) || !AllDigits(tail)) return "";
  if (stem[mark] == '_') return tail.size() <= 9 ? head + '.' + std::string(9 - tail.size(), '0') + tail : "";
  return stem;
}

// Runs of digits compare as numbers, all else byte by byte.
bool NaturalLess(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a;
  const std::string_view whole_b = b;
  const auto take_number = [](std::string_view* text) {
    std::size_t end = 0;
    while (end < text->size() && (*text)[end] >= '0' && (*text)[end] <= '9') ++end;
    std::string_view digits = text->substr(0, end);
    text->remove_prefix(end);
    while (digits.size() > 1 && digits.front() == '0') digits.remove_prefix(1);
    return digits;
  };
  while (!a.empty() && !b.empty()) {
    const std::string_view number_a = take_number(&a);
    const std::string_view number_b = take_number(&b);
    if (number_a.size() != number_b.size() && !number_a.empty() && !number_b.empty()) {
      return number_a.size() < number_b.size();
    }
    if (number_a != number_b) return number_a < number_b;
    if (a.empty() || b.empty()) break;
    if (a.front() != b.front()) return a.front() < b.front();
    a.remove_prefix(1);
    b.remove_prefix(1);
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;
}

std::vector<fs::path> CloudsIn(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const bool hidden = entry.path().filename().string().starts_with('.');
    if (!hidden && entry.is_regular_file() && IsCloudFile(entry.path())) files.push_back(entry.path());
  }
  return files;
}

// Compares "12.5" and "103.25" without rounding: by the length and digits of the whole part, then the decimals.
bool StampLess(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a.substr(0, a.find('.'));
  const std::string_view whole_b = b.substr(0, b.find('.'));
  if (whole_a != whole_b) return NaturalLess(whole_a, whole_b);
  return a.substr(whole_a.size()) < b.substr(whole_b.size());
}

void Sort(CloudListing* listing) {
  struct Named {
    fs::path path;
    std::string stem;
    std::string stamp;
  };
  std::vector<Named> named;
  bool stamped = true;
  bool numbered = true;
  for (const fs::path& path : listing->files) {
    const std::string stem = path.stem().string();
    named.push_back({path, stem, StampOf(stem)});
    stamped = stamped && !named.back().stamp.empty();
    numbered = numbered && AllDigits(stem) && stem.size() <= kStampDigits;
  }
  std::sort(named.begin(), named.end(), [&](const Named& a, const Named& b) {
    if (stamped && a.stamp != b.stamp) return StampLess(a.stamp, b.stamp);
    if (a.stem != b.stem) return NaturalLess(a.stem, b.stem);
    return a.path < b.path;
  });
  listing->files.clear();
  for (Named& n : named) {
    listing->files.push_back(std::move(n.path));
    if (numbered) listing->numbers.push_back(std::stoll(n.stem));
    if (stamped) listing->stamps.push_back(std::move(n.stamp));
  }
}

}  // namespace

CloudListing ListClouds(const fs::path& recording) {
  if (!fs::exists(recording)) {
    throw std::runtime_error(fmt::format("{} does not exist; check the path", recording.string()));
  }
  if (!fs::is_directory(recording)) {
    throw std::runtime_error(
        fmt::format("{} is a file; give the folder that holds the clouds and poses", recording.string()));
  }
  std::vector<fs::path> folders;
  for (const std::string_view name : kSubfolders) folders.push_back(recording / name);
  folders.push_back(recording);
  for (const fs::path& folder : folders) {
    CloudListing listing{folder, CloudsIn(folder), {}, {}};
    if (listing.files.empty()) continue;
    Sort(&listing);
    return listing;
  }
  if (fs::is_empty(recording)) {
    throw std::runtime_error(
        fmt::format("{} is empty; put clouds (velodyne/*.bin, *.pcd or *.ply) and poses there", recording.string()));
  }
  throw std::runtime_error(
      fmt::format("no clouds in {}; put them in velodyne/*.bin (KITTI) or clouds/*.pcd or *.ply", recording.string()));
}

std::optional<std::vector<TimeNs>> TimesFromNames(const CloudListing& listing, TimeNs first, TimeNs last) {
  if (listing.stamps.empty()) return std::nullopt;
  const DurationNs slack = FromSeconds(1);
  std::size_t best_inside = 0;
  std::optional<std::vector<TimeNs>> best;
  for (const std::size_t unit_digits : {0U, 3U, 6U, 9U}) {  // powers of ten per second
    std::vector<TimeNs> times;
    std::size_t inside = 0;
    for (const std::string& stamp : listing.stamps) {
      const bool decimal = stamp.find('.') != std::string::npos;
      std::string seconds = stamp;
      if (unit_digits > 0 && !decimal && stamp.size() > unit_digits) seconds.insert(stamp.size() - unit_digits, ".");
      TimeNs t;
      if ((unit_digits > 0 && (decimal || stamp.size() <= unit_digits)) || !ParseSeconds(seconds, &t)) break;
      times.push_back(t);
      if (t >= first - slack && t <= last + slack) ++inside;
    }
    if (times.size() != listing.stamps.size() || inside <= best_inside) continue;
    best_inside = inside;
    best = std::move(times);
  }
  return best;
}

}  // namespace mapweld::io
