// SPDX-License-Identifier: Apache-2.0
#include "tools/io/tum.hpp"

#include <fmt/format.h>

#include "tools/io/atomic_file.hpp"
#include "tools/io/text_rows.hpp"

namespace mapweld::io {

std::vector<StampedPose> ReadTum(const std::filesystem::path& path, PoseUse use) {
  const TextRows file(path);
  std::vector<StampedPose> trajectory;
  trajectory.reserve(file.rows().size());
  for (const TextRow& row : file.rows()) {
    file.ExpectColumns(row, 8, "time x y z qx qy qz qw");
    double v[8] = {};
    for (std::size_t i = 1; i < 8; ++i) v[i] = file.Number(row, i);
    geom::Quatd q(v[7], v[4], v[5], v[6]);
    if (std::abs(q.norm() - 1) > 0.1) {
      if (use == PoseUse::kWhole) {
        file.Fail(row, fmt::format("the quaternion has length {:.3f} instead of 1; write it as qx qy qz qw", q.norm()));
      }
      q = geom::Quatd::Identity();
    }
    trajectory.push_back({file.Seconds(row, 0), {{v[1], v[2], v[3]}, q.normalized()}});
    if (trajectory.size() > 1 && trajectory.back().t <= trajectory[trajectory.size() - 2].t) {
      file.Fail(row, "time does not increase; sort the rows by time and remove doubles");
    }
  }
  return trajectory;
}

void WriteTum(const std::filesystem::path& path, const std::vector<StampedPose>& trajectory) {
  AtomicFile file(path);
  file.Write("# timestamp x y z qx qy qz qw\n");
  for (const auto& [t, world_T_body] : trajectory) {
    const auto& p = world_T_body.t;
    const auto& q = world_T_body.q;
    file.Write(fmt::format("{} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n", FormatSeconds(t), p.x(), p.y(),
                           p.z(), q.x(), q.y(), q.z(), q.w()));
  }
  file.Commit();
}

}  // namespace mapweld::io
