// SPDX-License-Identifier: Apache-2.0
// One description per record, used both for writing and for reading: Visit calls the archive with every field in turn.
#include "tools/store/record_codec.hpp"

#include <bit>
#include <memory>
#include <type_traits>

#include "core/base/byte_io.hpp"
#include "core/submap/submap_codec.hpp"

namespace mapweld::store {
namespace {

enum class SubmapFormat : std::uint8_t { kPoints = 0, kAgent = 1 };

class Writer {
 public:
  static constexpr bool kReads = false;
  template <class T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void operator()(const T& value) { Append(&value, sizeof(T)); }
  void operator()(const double& value) { Append(&value, sizeof(value)); }
  void operator()(const float& value) { Append(&value, sizeof(value)); }
  void operator()(const std::string& text) {
    Count(text.size());
    Append(text.data(), text.size());
  }
  void Raw(const void* data, std::size_t bytes) { Append(data, bytes); }
  void Count(std::size_t n) { (*this)(static_cast<std::uint32_t>(n)); }
  Bytes Take() { return std::move(bytes_); }

 private:
  void Append(const void* data, std::size_t n) {
    const auto* from = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), from, from + n);
  }
  Bytes bytes_;
};

class Reader {
 public:
  static constexpr bool kReads = true;
  explicit Reader(std::span<const std::uint8_t> bytes) : reader_(bytes) {}
  template <class T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void operator()(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      const auto byte = reader_.Little<std::uint8_t>();
      value = byte == 1;
      wrong_ = wrong_ || byte > 1;
    } else {
      Raw(&value, sizeof(T));
    }
  }
  void operator()(double& value) { Raw(&value, sizeof(value)); }
  void operator()(float& value) { Raw(&value, sizeof(value)); }
  void operator()(std::string& text) {
    text.resize(Count(1));
    Raw(text.data(), text.size());
  }
  void Raw(void* data, std::size_t n) {
    const auto view = reader_.Bytes(n);
    if (view.size() == n && n > 0) std::memcpy(data, view.data(), n);
  }
  // Never more than the rest of the bytes can hold, so that a wrong count reserves no memory.
  std::size_t Count(std::size_t bytes_each) {
    const std::size_t n = reader_.Little<std::uint32_t>();
    if (n > reader_.remaining() / bytes_each) {
      wrong_ = true;
      return 0;
    }
    return n;
  }
  void Refuse() { wrong_ = true; }
  [[nodiscard]] bool Good() const { return !wrong_ && !reader_.failed() && reader_.remaining() == 0; }

 private:
  ByteReader reader_;
  bool wrong_ = false;
};

// A list with its count in front. bytes_each: the least that one element takes.
template <class Archive, class List, class Field>
void VisitList(Archive& io, List& list, std::size_t bytes_each, const Field& field) {
  if constexpr (Archive::kReads) {
    list.resize(io.Count(bytes_each));
  } else {
    io.Count(list.size());
  }
  for (auto& element : list) field(element);
}

template <class Archive, class Pose>
void VisitPose(Archive& io, Pose& pose) {
  for (int i = 0; i < 3; ++i) io(pose.t[i]);
  for (int i = 0; i < 4; ++i) io(pose.q.coeffs()[i]);
  if constexpr (Archive::kReads) {
    if (!pose.IsValid()) io.Refuse();
  }
}
constexpr std::size_t kPoseBytes = 56;

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
void VisitLoop(Archive& io, T& loop) {
  io(loop.keyframe_a);
  io(loop.keyframe_b);
  VisitPose(io, loop.a_T_b);
  io(loop.overlap_ratio);
  io(loop.residual_m);
  io(loop.weight);
}

template <class Archive, class T>
void VisitOverlap(Archive& io, T& overlap) {
  io(overlap.drive_a);
  io(overlap.drive_b);
  io(overlap.accepted);
  io(overlap.test);
  io(overlap.reverse);
  VisitPose(io, overlap.a_T_b);
  io(overlap.length_m);
  io(overlap.weight);
  VisitList(io, overlap.matches, 8, [&](auto& match) {
    io(match.first);
    io(match.second);
  });
  VisitList(io, overlap.loops, kPoseBytes, [&](auto& loop) { VisitLoop(io, loop); });
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

template <class T, class Visit>
Bytes Write(const T& value, const Visit& visit) {
  Writer writer;
  visit(writer, value);
  return writer.Take();
}

template <class T, class Visit>
bool Read(std::span<const std::uint8_t> bytes, T* out, const Visit& visit) {
  Reader reader(bytes);
  visit(reader, *out);
  return reader.Good();
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
