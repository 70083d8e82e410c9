// SPDX-License-Identifier: Apache-2.0
// Reads the recordings that the decoders are compared with: packets from bags and captures, clouds that the vendors'
// decoders made of the same packets.
#pragma once

#include <gtest/gtest.h>
#include <pcap/pcap.h>
#include <sqlite3.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "core/sensor/lidar_point.hpp"

namespace mapweld::lidar::test {

using Payload = std::vector<std::uint8_t>;

// The packets of every message of a bag in an SQLite file. CDR: 4 bytes of encapsulation, then stamp, frame name, count
// and packets, each {seconds, nanoseconds, `bytes` bytes, perhaps the u32 of bytes used}; integers are aligned to 4
// bytes counted from after the encapsulation.
inline std::vector<Payload> PacketsOfBag(const std::filesystem::path& file, std::size_t bytes, bool size_follows) {
  const auto read = [](const std::uint8_t* at) {
    std::uint32_t value = 0;
    std::memcpy(&value, at, sizeof(value));
    return value;
  };
  const auto align = [](std::size_t at) { return (at + 3) / 4 * 4; };
  std::vector<Payload> packets;
  sqlite3* database = nullptr;
  sqlite3_stmt* rows = nullptr;
  EXPECT_EQ(sqlite3_open_v2(file.c_str(), &database, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
  EXPECT_EQ(sqlite3_prepare_v2(database, "SELECT data FROM messages ORDER BY timestamp", -1, &rows, nullptr),
            SQLITE_OK);
  while (sqlite3_step(rows) == SQLITE_ROW) {
    const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(rows, 0)) + 4;
    std::size_t at = align(12 + read(data + 8));
    const std::uint32_t count = read(data + at);
    at += 4;
    for (std::uint32_t i = 0; i < count; ++i) {
      at = align(at) + 8;
      const std::size_t used = size_follows ? read(data + align(at + bytes)) : bytes;
      packets.emplace_back(data + at, data + at + used);
      at = size_follows ? align(at + bytes) + 4 : at + bytes;
    }
  }
  sqlite3_finalize(rows);
  sqlite3_close(database);
  return packets;
}

struct CapturedPayload {
  TimeNs receive;
  Payload payload;
};

// Every UDP payload of a capture of Ethernet frames with IPv4 headers without options.
inline std::vector<CapturedPayload> PacketsOfCapture(const std::filesystem::path& file) {
  std::array<char, PCAP_ERRBUF_SIZE> error{};
  pcap_t* capture = pcap_open_offline(file.c_str(), error.data());
  EXPECT_NE(capture, nullptr) << error.data();
  std::vector<CapturedPayload> packets;
  pcap_pkthdr* header = nullptr;
  const u_char* frame = nullptr;
  while (pcap_next_ex(capture, &header, &frame) == 1) {
    constexpr std::size_t kHeaders = 14 + 20 + 8;
    packets.push_back({{header->ts.tv_sec * 1'000'000'000LL + header->ts.tv_usec * 1000LL},
                       {frame + kHeaders, frame + header->caplen}});
  }
  pcap_close(capture);
  return packets;
}

struct VendorPoint {
  float x, y, z;
};

// Positions of a binary PCD file whose points begin with x, y, z and take `stride` bytes.
inline std::vector<VendorPoint> VendorCloud(const std::filesystem::path& file, std::size_t stride) {
  std::ifstream in(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::string marker = "DATA binary\n";
  std::vector<VendorPoint> cloud;
  for (std::size_t at = text.find(marker) + marker.size(); at + stride <= text.size(); at += stride) {
    VendorPoint point{};
    std::memcpy(&point, text.data() + at, sizeof(point));
    cloud.push_back(point);
  }
  return cloud;
}

// Our points, found by their range, which is a whole number of millimetres.
class CloudIndex {
 public:
  void Add(double x, double y, double z) { by_mm_[Key(x, y, z)].push_back({x, y, z}); }

  // Distance to the nearest of our points of the same range; more than a metre when there is none.
  [[nodiscard]] double Nearest_m(const VendorPoint& p) const {
    double best = 10;
    const auto same = by_mm_.find(Key(double{p.x}, double{p.y}, double{p.z}));
    if (same == by_mm_.end()) return best;
    for (const auto& [x, y, z] : same->second) {
      best = std::min(best, std::hypot(x - double{p.x}, y - double{p.y}, z - double{p.z}));
    }
    return best;
  }

  // Share of the cloud within `limit_m`; the largest distance of the others is in *worst_m.
  [[nodiscard]] double ShareWithin(double limit_m, const std::vector<VendorPoint>& cloud, double* worst_m) const {
    std::size_t within = 0;
    *worst_m = 0;
    for (const VendorPoint& p : cloud) {
      const double distance = Nearest_m(p);
      within += distance <= limit_m ? 1 : 0;
      *worst_m = std::max(*worst_m, distance);
    }
    return static_cast<double>(within) / static_cast<double>(cloud.size());
  }

 private:
  static std::int64_t Key(double x, double y, double z) { return std::llround(std::hypot(x, y, z) * 1000); }
  std::map<std::int64_t, std::vector<std::array<double, 3>>> by_mm_;
};

}  // namespace mapweld::lidar::test
