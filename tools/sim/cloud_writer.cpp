// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/cloud_writer.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "tools/sim/output_file.hpp"

namespace mapweld::sim {
namespace {

using Points = std::vector<Eigen::Vector3f>;

struct Scan {
  std::int64_t past_hour_ns = 0;
  geom::Pose3 world_T_body;
  Points world_points;
};

std::string Row(const geom::Pose3& pose, const char* separator) {
  const geom::Mat3d r = pose.q.toRotationMatrix();
  std::string row;
  for (int i = 0; i < 3; ++i) {
    row += fmt::format("{2}{0:.9g}{1}{3:.9g}{1}{4:.9g}{1}{5:.9g}", r(i, 0), separator, i > 0 ? separator : "", r(i, 1),
                       r(i, 2), pose.t[i]);
  }
  return row;
}

// x y z intensity as four floats.
void WriteBin(const std::filesystem::path& file, const Points& body_points) {
  std::vector<std::uint8_t> bytes(body_points.size() * 16);
  for (std::size_t i = 0; i < body_points.size(); ++i) {
    std::memcpy(bytes.data() + 16 * i, body_points[i].data(), 12);
  }
  OutputFile out(file);
  out.Write(std::span<const std::uint8_t>(bytes));
  out.Close();
}

Points InFrame(const geom::Pose3& world_T_frame, const Points& world_points) {
  const geom::Pose3 frame_T_world = world_T_frame.Inverse();
  Points out;
  out.reserve(world_points.size());
  for (const Eigen::Vector3f& p : world_points) {
    out.emplace_back((frame_T_world * geom::Vec3d(p.cast<double>())).cast<float>());
  }
  return out;
}

class LayoutWriter {
 public:
  LayoutWriter() = default;
  virtual ~LayoutWriter() = default;
  LayoutWriter(const LayoutWriter&) = delete;
  LayoutWriter& operator=(const LayoutWriter&) = delete;
  virtual void Add(const Scan& scan) = 0;
  virtual void Close() = 0;
};

class Kitti final : public LayoutWriter {
 public:
  explicit Kitti(const std::filesystem::path& dir)
      : clouds_(dir / "velodyne"), poses_(dir / "poses.txt"), times_(dir / "times.txt") {
    std::filesystem::create_directories(clouds_);
    OutputFile calibration(dir / "calib.txt");
    calibration.Write("Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
    calibration.Close();
  }
  void Add(const Scan& scan) override {
    if (count_ == 0) first_ = scan;
    WriteBin(clouds_ / fmt::format("{:06}.bin", count_++), InFrame(scan.world_T_body, scan.world_points));
    poses_.Write(Row(first_.world_T_body.Inverse() * scan.world_T_body, " ") + "\n");
    times_.Write(fmt::format("{:.6f}\n", static_cast<double>(scan.past_hour_ns - first_.past_hour_ns) * 1e-9));
  }
  void Close() override {
    poses_.Close();
    times_.Close();
  }

 private:
  std::filesystem::path clouds_;
  OutputFile poses_;
  OutputFile times_;
  Scan first_;
  int count_ = 0;
};

class Mulran final : public LayoutWriter {
 public:
  explicit Mulran(const std::filesystem::path& dir) : clouds_(dir / "Ouster"), poses_(dir / "global_pose.csv") {
    std::filesystem::create_directories(clouds_);
  }
  void Add(const Scan& scan) override {
    WriteBin(clouds_ / fmt::format("{}.bin", scan.past_hour_ns), InFrame(scan.world_T_body, scan.world_points));
    poses_.Write(fmt::format("{},{}\n", scan.past_hour_ns, Row(scan.world_T_body, ",")));
  }
  void Close() override { poses_.Close(); }

 private:
  std::filesystem::path clouds_;
  OutputFile poses_;
};

class Gprs final : public LayoutWriter {
 public:
  explicit Gprs(std::filesystem::path dir) : dir_(std::move(dir)) {}
  void Add(const Scan& scan) override {
    if (!scans_.empty()) path_m_ += (scan.world_T_body.t - scans_.back().second.world_T_body.t).norm();
    scans_.emplace_back(path_m_, scan);
    while (path_m_ - scans_.front().first > kLength_m) scans_.pop_front();
    if (path_m_ < next_m_) return;
    next_m_ += kSpacing_m;
    ++count_;
    Points points;
    for (const auto& [at, s] : scans_) points.insert(points.end(), s.world_points.begin(), s.world_points.end());
    WritePcd(InFrame(scan.world_T_body, points));
    WritePose(scan.world_T_body);
  }
  void Close() override {}

 private:
  static constexpr double kLength_m = 50;
  static constexpr double kSpacing_m = 5;

  void WritePcd(const Points& points) {
    OutputFile out(dir_ / fmt::format("{:06}.pcd", count_));
    out.Write(
        fmt::format("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {0}\n"
                    "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
                    points.size()));
    std::vector<std::uint8_t> bytes(points.size() * 12);
    for (std::size_t i = 0; i < points.size(); ++i) std::memcpy(bytes.data() + 12 * i, points[i].data(), 12);
    out.Write(std::span<const std::uint8_t>(bytes));
    out.Close();
  }
  // Six doubles as numpy.save writes them, version 1.0.
  void WritePose(const geom::Pose3& pose) {
    const geom::Mat3d r = pose.q.toRotationMatrix();
    const std::array<double, 6> values{pose.t.x(),          pose.t.y(),
                                       pose.t.z(),          std::atan2(r(2, 1), r(2, 2)),
                                       std::asin(-r(2, 0)), std::atan2(r(1, 0), r(0, 0))};
    std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (6,), }";
    header.resize(117, ' ');
    header += '\n';
    OutputFile out(dir_ / fmt::format("{:06}_pose6d.npy", count_));
    const std::array<std::uint8_t, 10> magic{0x93, 'N', 'U', 'M', 'P', 'Y', 1, 0, 118, 0};
    out.Write(std::span<const std::uint8_t>(magic));
    out.Write(header);
    std::array<std::uint8_t, sizeof values> bytes;
    std::memcpy(bytes.data(), values.data(), sizeof values);
    out.Write(std::span<const std::uint8_t>(bytes));
    out.Close();
  }

  std::filesystem::path dir_;
  std::deque<std::pair<double, Scan>> scans_;  // with the path driven so far
  double path_m_ = 0;
  double next_m_ = 0;
  int count_ = 0;
};

std::unique_ptr<LayoutWriter> MakeLayout(CloudLayout layout, const std::filesystem::path& dir) {
  switch (layout) {
    case CloudLayout::kMulran:
      return std::make_unique<Mulran>(dir);
    case CloudLayout::kGprs:
      return std::make_unique<Gprs>(dir);
    case CloudLayout::kKitti:
      break;
  }
  return std::make_unique<Kitti>(dir);
}

}  // namespace

std::int64_t WriteClouds(const RayCaster& caster, const VehicleMotion& motion, const Traffic* traffic,
                         const CloudSpec& spec, const std::filesystem::path& dir,
                         const std::function<void(double)>& progress) {
  const LidarSimulator lidar(caster, motion, traffic, spec.lidar, spec.weather, spec.start_past_hour_ns, spec.seed);
  const std::unique_ptr<LayoutWriter> layout = MakeLayout(spec.layout, dir);
  Scan scan;
  std::int64_t clouds = 0;
  const auto revolutions = static_cast<std::int64_t>(spec.duration_s * 1e9) / kRevolution_ns;
  for (std::int64_t i = 0; i < revolutions; ++i) {
    const geom::Pose3 world_T_body = motion.WorldFromBody(static_cast<double>(i * kRevolution_ns) * 1e-9);
    if (i > 0 && (world_T_body.t - scan.world_T_body.t).norm() < spec.scan_spacing_m) continue;
    scan.past_hour_ns = spec.start_past_hour_ns + i * kRevolution_ns;
    scan.world_T_body = world_T_body;
    scan.world_points.clear();
    const std::int64_t first = i * kRevolution_ns * 1000 / spec.lidar.column_ps;
    for (std::int64_t c = first; c < first + lidar.ColumnsPerRevolution(); ++c)
      lidar.AppendPoints(c, &scan.world_points);
    layout->Add(scan);
    ++clouds;
    if (i % 64 == 0) progress(static_cast<double>(i) / static_cast<double>(revolutions));
  }
  layout->Close();
  progress(1);
  return clouds;
}

}  // namespace mapweld::sim
