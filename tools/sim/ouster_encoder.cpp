// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/ouster_encoder.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "core/base/byte_io.hpp"

namespace mapweld::sim {
namespace {

constexpr std::size_t kHeaderBytes = 32;  // as many at the end
constexpr std::size_t kColumnHeaderBytes = 12;
constexpr std::size_t kPixelBytes = 12;
constexpr std::uint16_t kLidarPacket = 1;
constexpr std::uint16_t kValidColumn = 1;

std::int64_t ColumnsPerTurn(const LidarModel& model) {
  return kRevolution_ns * 1000 / model.column_ps;
}

// The sensor is mounted with its connector backward, where its columns begin.
std::uint16_t MeasurementId(const LidarSimulator& lidar, std::int64_t column) {
  const std::int64_t per_turn = ColumnsPerTurn(lidar.model());
  const auto from_forward = std::llround(lidar.Azimuth_deg(column) / 360 * static_cast<double>(per_turn));
  return static_cast<std::uint16_t>((from_forward + per_turn / 2) % per_turn);
}

void WritePixel(const LidarReturn& r, ByteWriter* w) {
  constexpr double kLongest_mm = (1 << 19) - 1;
  const double range_mm =
      r.distance_m > 0 ? std::clamp(std::round(1e3 * static_cast<double>(r.distance_m)), 1.0, kLongest_mm) : 0;
  w->Little(static_cast<std::uint32_t>(range_mm));
  w->Little(r.distance_m > 0 ? r.reflectivity : std::uint8_t{0});
  w->Little(std::uint8_t{0});
  w->Little(static_cast<std::uint16_t>(r.distance_m > 0 ? r.reflectivity : 0));  // signal
  w->Little(std::uint32_t{0});                                                   // near infrared, unused
}

}  // namespace

bool IsOuster(const LidarModel& model) {
  return model.name.starts_with("os1");
}

std::vector<std::uint8_t> EncodeOuster(const LidarSimulator& lidar, std::int64_t index, std::int64_t* returns) {
  const std::size_t beams = lidar.model().beams.size();
  const std::size_t columns_bytes =
      static_cast<std::size_t>(kOusterColumns) * (kColumnHeaderBytes + beams * kPixelBytes);
  std::vector<std::uint8_t> bytes(2 * kHeaderBytes + columns_bytes);
  // A frame begins where the columns' count does.
  const std::int64_t first = index * kOusterColumns;
  const std::int64_t per_turn = ColumnsPerTurn(lidar.model());
  const auto frame = static_cast<std::uint16_t>((first + MeasurementId(lidar, 0)) / per_turn);
  ByteWriter header(std::span<std::uint8_t>(bytes).first(kHeaderBytes));
  header.Little(kLidarPacket);
  header.Little(frame);
  ByteWriter w(std::span<std::uint8_t>(bytes).subspan(kHeaderBytes, columns_bytes));
  std::vector<LidarReturn> column_returns;
  for (std::int64_t i = 0; i < kOusterColumns; ++i) {
    const std::int64_t column = first + i;
    w.Little(static_cast<std::uint64_t>(lidar.PastHour_ns(column)));
    w.Little(MeasurementId(lidar, column));
    w.Little(kValidColumn);
    lidar.Column(column, &column_returns);
    for (const LidarReturn& r : column_returns) {
      *returns += r.distance_m > 0 ? 1 : 0;
      WritePixel(r, &w);
    }
  }
  return bytes;
}

std::string OusterMetadataJson(const LidarModel& model) {
  using nlohmann::ordered_json;
  ordered_json altitude = ordered_json::array();
  ordered_json azimuth = ordered_json::array();
  for (const Beam& beam : model.beams) {
    altitude.push_back(beam.elevation_deg);
    azimuth.push_back(beam.azimuth_deg);
  }
  const ordered_json metadata = {
      {"sensor_info", {{"prod_line", "OS-1-64"}, {"image_rev", "simulated by mapweld"}}},
      {"beam_intrinsics",
       {{"beam_altitude_angles", altitude}, {"beam_azimuth_angles", azimuth}, {"lidar_origin_to_beam_origin_mm", 0.0}}},
      {"config_params",
       {{"lidar_mode", std::to_string(ColumnsPerTurn(model)) + "x10"},
        {"udp_profile_lidar", "RNG19_RFL8_SIG16_NIR16"},
        {"udp_port_lidar", kOusterPort}}}};
  return metadata.dump(1) + "\n";
}

}  // namespace mapweld::sim
