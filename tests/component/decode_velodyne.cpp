// SPDX-License-Identifier: Apache-2.0
// decode_velodyne CAPTURE: every VLP-16 return of a capture as our driver sees it, one "packet x y z dt_ns" per line.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "drivers/lidar/velodyne_codec.hpp"

int main(int argc, char** argv) {
  constexpr std::size_t kFileHeader = 24;
  constexpr std::size_t kToPayload = 16 + 14 + 20 + 8;  // record, Ethernet, IP, UDP
  constexpr std::size_t kPayload = mapweld::lidar::VelodynePacket::kPayloadBytes;
  if (argc != 2) return 2;
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  mapweld::lidar::VelodyneCodec codec(mapweld::lidar::kVlp16);
  const auto packet = std::make_unique<mapweld::sensor::LidarPacket>();
  int number = 0;
  for (std::size_t at = kFileHeader; at + kToPayload + kPayload <= bytes.size(); at += kToPayload + kPayload) {
    const auto* payload = reinterpret_cast<const std::uint8_t*>(bytes.data() + at + kToPayload);
    if (codec.Decode({payload, kPayload}, {}, packet.get()) != mapweld::Status::kOk) return 1;
    for (const mapweld::sensor::LidarPoint& p : packet->points) {
      std::printf("%d %.6f %.6f %.6f %d\n", number, static_cast<double>(p.x), static_cast<double>(p.y),
                  static_cast<double>(p.z), static_cast<int>(p.dt_ns));
    }
    ++number;
  }
  return number > 0 ? 0 : 1;
}
