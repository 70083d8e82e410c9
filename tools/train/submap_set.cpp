// SPDX-License-Identifier: Apache-2.0
// Writes the submaps of simulated drives or recordings, with their true poses, as one flat file for the trainer:
//   train_submaps -o SET.bin [--truth-folder DIR] INPUT...
// File: "MWSUBMAP" then, per keyframe, int32 drive, int32 points, float64[12] world_T_level (3 x 4, row-major), int16
// x y z per point in centimetres, little endian. Drives follow one another in the order of their names.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <stdexcept>

#include "core/geom/pose3.hpp"
#include "tools/io/tum.hpp"
#include "tools/mapweld/merge_inputs.hpp"

namespace {

using namespace mapweld;

struct Arguments {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path truth_folder;
  std::filesystem::path out;
};

// True pose of each keyframe; the drive's own odometry where there is no truth folder.
std::vector<geom::Pose3> TruePoses(const merge::Drive& drive, const std::filesystem::path& folder) {
  std::vector<geom::Pose3> poses;
  if (folder.empty()) {
    for (const merge::Keyframe& k : drive.keyframes) poses.push_back(k.odom_T_body);
    return poses;
  }
  std::map<std::int64_t, geom::Pose3> at;  // by microsecond: the text has six digits
  for (const io::StampedPose& row : io::ReadTum(folder / (drive.name + ".tum"))) at[row.t.ns / 1000] = row.world_T_body;
  for (const merge::Keyframe& k : drive.keyframes) {
    const auto after = at.lower_bound(k.t.ns / 1000 - 1);
    if (after == at.end() || std::abs(after->first - k.t.ns / 1000) > 1) {
      throw std::runtime_error(fmt::format("{}: no true pose at keyframe time {} ns", drive.name, k.t.ns));
    }
    poses.push_back(after->second);
  }
  return poses;
}

template <typename T>
void Put(std::ofstream* file, const T& value) {
  file->write(reinterpret_cast<const char*>(&value), sizeof value);
}

void PutKeyframe(std::ofstream* file, int drive, const geom::Pose3& world_T_body, const merge::SubmapCloud& cloud) {
  const geom::Pose3 world_T_level = geom::Level(world_T_body);
  Put(file, static_cast<std::int32_t>(drive));
  Put(file, static_cast<std::int32_t>(cloud.points.size()));
  const Eigen::Matrix3d r = world_T_level.q.toRotationMatrix();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) Put(file, r(row, column));
    Put(file, world_T_level.t[row]);
  }
  for (const Eigen::Vector3f& p : cloud.points) {
    for (int axis = 0; axis < 3; ++axis) Put(file, static_cast<std::int16_t>(std::lround(p[axis] * 100)));
  }
}

void Write(const Arguments& arguments) {
  merge::TerminalProgress progress("train_submaps");
  const std::vector<merge::MergeInput> inputs = merge::OpenInputs(arguments.inputs, 0, &progress);
  std::ofstream file(arguments.out, std::ios::binary);
  file.write("MWSUBMAP", 8);
  std::size_t written = 0;
  for (std::size_t d = 0; d < inputs.size(); ++d) {
    progress.SetSubject(inputs[d].name);
    const merge::BuiltDrive built = inputs[d].build();
    const std::vector<geom::Pose3> poses = TruePoses(built.drive, arguments.truth_folder);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const auto cloud = built.submap(static_cast<int>(k));
      if (cloud == nullptr) continue;
      PutKeyframe(&file, static_cast<int>(d), poses[k], *cloud);
      ++written;
    }
  }
  if (!file.flush()) throw std::runtime_error(fmt::format("cannot write {}", arguments.out.string()));
  fmt::print("{}: {} submaps of {} drives\n", arguments.out.string(), written, inputs.size());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Submaps with true poses, for training");
  Arguments arguments;
  app.add_option("inputs", arguments.inputs, "Recordings or LCM logs")->required();
  app.add_option("--truth-folder", arguments.truth_folder, "NAME.tum per drive; default: the recordings' own poses");
  app.add_option("-o,--out", arguments.out, "File to write")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    Write(arguments);
  } catch (const std::exception& e) {
    fmt::print(stderr, "train_submaps: {}\n", e.what());
    return 1;
  }
  return 0;
}
