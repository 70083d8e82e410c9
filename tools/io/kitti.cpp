// SPDX-License-Identifier: Apache-2.0
#include "tools/io/kitti.hpp"

#include <fmt/format.h>

#include <cstring>
#include <stdexcept>

#include "tools/io/atomic_file.hpp"
#include "tools/io/text_rows.hpp"

namespace mapweld::io {
namespace {

// Rows are rounded to six digits or so; a rotation that is off by more than this was not written as one.
constexpr double kOrthonormalTolerance = 0.02;

geom::Pose3 PoseFromRow(const TextRows& file, const TextRow& row, std::size_t first_column) {
  Eigen::Matrix<double, 3, 4> m;
  for (Eigen::Index i = 0; i < 12; ++i) {
    m(i / 4, i % 4) = file.Number(row, first_column + static_cast<std::size_t>(i));
  }
  const Eigen::Matrix3d rotation = m.leftCols<3>();
  const double error = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (error > kOrthonormalTolerance || rotation.determinant() < 0) {
    file.Fail(row, "the 3x3 part is not a rotation; write the rows as r11 r12 r13 tx r21 r22 r23 ty r31 r32 r33 tz");
  }
  return {m.col(3), geom::Quatd(rotation).normalized()};
}

}  // namespace

PointCloud ReadKittiCloud(const std::filesystem::path& path) {
  const std::string bytes = ReadFile(path);
  const std::size_t count = bytes.size() / kKittiPointBytes;
  if (bytes.size() % kKittiPointBytes != 0) {
    throw std::runtime_error(fmt::format(
        "{} is truncated: {} bytes are no whole number of points, the last one is cut at offset {}; copy or record the "
        "file again (float32 x y z intensity)",
        path.string(), bytes.size(), count * kKittiPointBytes));
  }
  PointCloud cloud;
  cloud.points.resize(count);
  cloud.intensities.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const char* record = bytes.data() + i * kKittiPointBytes;
    std::memcpy(cloud.points[i].data(), record, 3 * sizeof(float));
    std::memcpy(&cloud.intensities[i], record + 3 * sizeof(float), sizeof(float));
  }
  return cloud;
}

void WriteKittiCloud(const std::filesystem::path& path, const PointCloud& cloud) {
  AtomicFile file(path);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    const float record[4] = {p.x(), p.y(), p.z(), cloud.intensities.empty() ? 0.0F : cloud.intensities[i]};
    file.Write(std::string_view(reinterpret_cast<const char*>(record), sizeof(record)));
  }
  file.Commit();
}

std::vector<geom::Pose3> ReadKittiPoses(const std::filesystem::path& path) {
  const TextRows file(path);
  std::vector<geom::Pose3> poses;
  poses.reserve(file.rows().size());
  for (const TextRow& row : file.rows()) {
    file.ExpectColumns(row, 12, "a 3x4 pose, row-major");
    poses.push_back(PoseFromRow(file, row, 0));
  }
  return poses;
}

void WriteKittiPoses(const std::filesystem::path& path, const std::vector<geom::Pose3>& world_T_body) {
  AtomicFile file(path);
  for (const geom::Pose3& pose : world_T_body) {
    Eigen::Matrix<double, 3, 4> m;
    m << pose.q.toRotationMatrix(), pose.t;
    for (Eigen::Index i = 0; i < 12; ++i) {
      file.Write(fmt::format("{:.9f}{}", m(i / 4, i % 4), i == 11 ? '\n' : ' '));
    }
  }
  file.Commit();
}

std::vector<TimeNs> ReadKittiTimes(const std::filesystem::path& path) {
  const TextRows file(path);
  std::vector<TimeNs> times;
  times.reserve(file.rows().size());
  for (const TextRow& row : file.rows()) {
    file.ExpectColumns(row, 1, "a time in seconds");
    times.push_back(file.Seconds(row, 0));
    if (times.size() > 1 && times.back() <= times[times.size() - 2]) {
      file.Fail(row, "time does not increase; sort the scans by time and remove doubles");
    }
  }
  return times;
}

std::optional<geom::Pose3> ReadKittiCalibration(const std::filesystem::path& path) {
  const TextRows file(path);
  for (const TextRow& row : file.rows()) {
    if (row.words[0] != "Tr:") continue;
    file.ExpectColumns(row, 13, "Tr: and a 3x4 pose, row-major");
    return PoseFromRow(file, row, 1);
  }
  return std::nullopt;
}

}  // namespace mapweld::io
