// SPDX-License-Identifier: Apache-2.0
#include "tools/store/record_codec.hpp"

#include <memory>

#include "core/submap/submap_codec.hpp"
#include "tools/store/record_archive.hpp"

namespace mapweld::store {
namespace {

enum class SubmapFormat : std::uint8_t { kPoints = 0, kAgent = 1 };

template <class Archive, class T>
void VisitDrive(Archive& io, T& drive) {
  io(drive.name);
  io(drive.agent);
  io(drive.epoch);
  io(drive.published);
  io(drive.ended);
  io(drive.disputed);
  io(drive.fingerprint);
}

// The number of values goes with them: a program with another descriptor refuses the record.
template <class Archive, class Array>
void VisitQuantised(Archive& io, Array& values) {
  auto n = static_cast<std::uint32_t>(values.size());
  io(n);
  if constexpr (Archive::kReads) {
    if (n != values.size()) return io.Refuse();
  }
  io.Raw(values.data(), values.size());
}

template <class Archive, class T>
void VisitKeyframe(Archive& io, T& keyframe) {
  io(keyframe.t.ns);
  VisitPose(io, keyframe.odom_T_body);
  io(keyframe.path_m);
  io(keyframe.flushed);
  io(keyframe.place.descriptor.scale);
  VisitQuantised(io, keyframe.place.descriptor.q);
  io(keyframe.place.orientation.scale);
  VisitQuantised(io, keyframe.place.orientation.q);
}

template <class Archive, class T>
void VisitTrajectory(Archive& io, T& trajectory) {
  VisitList(io, trajectory.times, 8, [&](auto& t) { io(t.ns); });
  VisitList(io, trajectory.odom_T_scan, kPoseBytes, [&](auto& pose) { VisitPose(io, pose); });
  VisitList(io, trajectory.scan_path_m, 8, [&](auto& path) { io(path); });
}

template <class Archive, class T>
void VisitPair(Archive& io, T& pair) {
  io(pair.method);
  io(pair.keyframes_a);
  io(pair.keyframes_b);
  io(pair.proposed);
  io(pair.evidence);
  VisitOverlap(io, pair.overlap);
  VisitList(io, pair.asked, 9, [&](auto& asked) {
    io(asked.first.drive);
    io(asked.first.keyframe);
    io(asked.second);
  });
}

template <class Archive, class T>
void VisitMerge(Archive& io, T& merge) {
  io(merge.when);
  io(merge.cause);
  io(merge.is_final);
  VisitList(io, merge.drives, 4, [&](auto& name) { io(name); });
  VisitList(io, merge.keyframes, 4, [&](auto& n) { io(n); });
  VisitList(io, merge.groups, 4, [&](auto& group) { VisitList(io, group, 4, [&](auto& drive) { io(drive); }); });
  VisitList(io, merge.overlaps, kPoseBytes, [&](auto& overlap) { VisitOverlap(io, overlap); });
  VisitList(io, merge.merged_T_body, 4,
            [&](auto& poses) { VisitList(io, poses, kPoseBytes, [&](auto& pose) { VisitPose(io, pose); }); });
}

template <class Archive, class T>
void VisitRuling(Archive& io, T& ruling) {
  io(ruling.kind);
  io(ruling.drive_a);
  io(ruling.drive_b);
  io(ruling.when);
}

// Indices that a wrong record could carry beyond its own lists.
bool IndicesFit(const MergeRecord& merge) {
  const auto n = static_cast<std::int32_t>(merge.drives.size());
  if (merge.keyframes.size() != merge.drives.size() || merge.merged_T_body.size() != merge.drives.size()) return false;
  const auto fits = [&](std::int32_t drive) { return drive >= 0 && drive < n; };
  for (const auto& group : merge.groups) {
    for (const std::int32_t drive : group) {
      if (!fits(drive)) return false;
    }
  }
  for (const merge::Overlap& overlap : merge.overlaps) {
    if (!fits(overlap.drive_a) || !fits(overlap.drive_b)) return false;
  }
  return true;
}

}  // namespace

Bytes Encode(const DriveInfo& drive) {
  return Write(drive, [](auto& io, auto& x) { VisitDrive(io, x); });
}
Bytes Encode(const merge::Keyframe& keyframe) {
  return Write(keyframe, [](auto& io, auto& x) { VisitKeyframe(io, x); });
}
Bytes Encode(const ScanTrajectory& trajectory) {
  return Write(trajectory, [](auto& io, auto& x) { VisitTrajectory(io, x); });
}
Bytes Encode(const PairRecord& pair) {
  return Write(pair, [](auto& io, auto& x) { VisitPair(io, x); });
}
Bytes Encode(const MergeRecord& merge) {
  return Write(merge, [](auto& io, auto& x) { VisitMerge(io, x); });
}
Bytes Encode(const Ruling& ruling) {
  return Write(ruling, [](auto& io, auto& x) { VisitRuling(io, x); });
}

Bytes Encode(const merge::SubmapCloud& cloud) {
  Writer writer;
  writer(SubmapFormat::kPoints);
  writer.Raw(cloud.points.data(), cloud.points.size() * sizeof(Eigen::Vector3f));
  return writer.Take();
}

Bytes EncodedByAgent(std::span<const std::uint8_t> submap) {
  Writer writer;
  writer(SubmapFormat::kAgent);
  writer.Raw(submap.data(), submap.size());
  return writer.Take();
}

bool Decode(std::span<const std::uint8_t> bytes, DriveInfo* out) {
  return Read(bytes, out, [](auto& io, auto& x) { VisitDrive(io, x); });
}
bool Decode(std::span<const std::uint8_t> bytes, merge::Keyframe* out) {
  return Read(bytes, out, [](auto& io, auto& x) { VisitKeyframe(io, x); });
}
bool Decode(std::span<const std::uint8_t> bytes, ScanTrajectory* out) {
  return Read(bytes, out, [](auto& io, auto& x) { VisitTrajectory(io, x); }) &&
         out->times.size() == out->odom_T_scan.size() && out->times.size() == out->scan_path_m.size();
}
bool Decode(std::span<const std::uint8_t> bytes, PairRecord* out) {
  return Read(bytes, out, [](auto& io, auto& x) { VisitPair(io, x); });
}
bool Decode(std::span<const std::uint8_t> bytes, MergeRecord* out) {
  return Read(bytes, out, [](auto& io, auto& x) { VisitMerge(io, x); }) && IndicesFit(*out);
}
bool Decode(std::span<const std::uint8_t> bytes, Ruling* out) {
  return Read(bytes, out, [](auto& io, auto& x) { VisitRuling(io, x); }) && out->kind <= Ruling::Kind::kQuarantine;
}

bool Decode(std::span<const std::uint8_t> bytes, merge::SubmapCloud* out) {
  out->points.clear();
  if (bytes.empty()) return false;
  const auto format = static_cast<SubmapFormat>(bytes.front());
  const auto content = bytes.subspan(1);
  if (format == SubmapFormat::kPoints) {
    constexpr std::size_t kPointBytes = sizeof(Eigen::Vector3f);
    static_assert(kPointBytes == 12);
    if (content.size() % kPointBytes != 0) return false;
    out->points.resize(content.size() / kPointBytes);
    if (!content.empty()) std::memcpy(static_cast<void*>(out->points.data()), content.data(), content.size());
    return true;
  }
  if (format != SubmapFormat::kAgent) return false;
  const auto submap = std::make_unique<submap::Submap>();
  if (submap::DecodeSubmap(content, submap.get()) != Status::kOk) return false;
  out->points.reserve(submap->points.size());
  for (const submap::SubmapPoint& p : submap->points) out->points.emplace_back(p.x, p.y, p.z);
  return true;
}

}  // namespace mapweld::store
