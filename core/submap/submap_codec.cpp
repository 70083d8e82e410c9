// SPDX-License-Identifier: Apache-2.0
#include "core/submap/submap_codec.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/byte_io.hpp"
#include "core/base/crc32.hpp"

namespace mapweld::submap {
namespace {

// header | n x (varint: cells since the last point, u16: x5 y5 z5 seen-more-than-once1) | CRC-32 of all before
constexpr std::uint32_t kMagic = 0x314D534D;  // "MSM1"
constexpr std::size_t kHeaderBytes = 4 + 1 + 2 + 2 + 4 + 8 + 4;
constexpr std::size_t kCrcBytes = 4;
constexpr std::int32_t kHalfExtent = 128;  // cells run from -128 to 127 on each axis
constexpr float kSteps = 32.0F;

struct GridPoint {
  std::uint32_t cell = 0;  // z, y, x, 8 bits each
  std::uint16_t offset = 0;
};

bool ToGrid(const SubmapPoint& p, float voxel_m, GridPoint* out) {
  const float v[3] = {p.x / voxel_m, p.y / voxel_m, p.z / voxel_m};
  std::uint32_t cell = 0;
  std::uint32_t offset = 0;
  for (int axis = 2; axis >= 0; --axis) {
    if (!(v[axis] >= static_cast<float>(-kHalfExtent) && v[axis] < static_cast<float>(kHalfExtent))) return false;
    const float floor_v = std::floor(v[axis]);
    const auto step = std::min(static_cast<std::uint32_t>((v[axis] - floor_v) * kSteps), 31U);
    cell = (cell << 8U) | static_cast<std::uint32_t>(static_cast<std::int32_t>(floor_v) + kHalfExtent);
    offset = (offset << 5U) | step;
  }
  out->cell = cell;
  out->offset = static_cast<std::uint16_t>((offset << 1U) | (p.count > 1 ? 1U : 0U));
  return true;
}

SubmapPoint FromGrid(const GridPoint& g, float voxel_m) {
  float v[3];
  for (unsigned axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::int32_t>((g.cell >> (8U * axis)) & 0xFFU) - kHalfExtent;
    const auto step = static_cast<float>((g.offset >> (1U + 5U * axis)) & 31U);
    v[axis] = (static_cast<float>(cell) + (step + 0.5F) / kSteps) * voxel_m;
  }
  return {v[0], v[1], v[2], static_cast<std::uint16_t>(1U + (g.offset & 1U)), 0};
}

}  // namespace

Result<std::size_t> EncodeSubmap(const Submap& submap, std::span<std::uint8_t> out) {
  ByteWriter writer(out);
  writer.Little(kMagic);
  writer.Little(static_cast<std::uint8_t>(submap.flushed ? 1 : 0));
  writer.Little(static_cast<std::uint16_t>(std::lround(submap.voxel_m * 1000.0F)));
  writer.Little(static_cast<std::uint16_t>(std::lround(submap.radius_m * 100.0F)));
  writer.Little(submap.keyframe);
  writer.Little(submap.t.ns);
  writer.Little(static_cast<std::uint32_t>(submap.points.size()));
  std::uint32_t previous = 0;
  for (const SubmapPoint& point : submap.points) {
    GridPoint g;
    if (!ToGrid(point, submap.voxel_m, &g)) return Status::kOutOfRange;
    if (g.cell < previous) return Status::kBadInput;
    std::uint32_t delta = g.cell - previous;
    previous = g.cell;
    while (delta >= 0x80U) {
      writer.Little(static_cast<std::uint8_t>(delta | 0x80U));
      delta >>= 7U;
    }
    writer.Little(static_cast<std::uint8_t>(delta));
    writer.Little(g.offset);
  }
  if (writer.failed()) return Status::kFull;
  writer.Little(Crc32(writer.written()));
  if (writer.failed()) return Status::kFull;
  return writer.size();
}

Status DecodeSubmap(std::span<const std::uint8_t> bytes, Submap* submap) {
  submap->points.clear();
  if (bytes.size() < kHeaderBytes + kCrcBytes) return Status::kBadInput;
  const auto body = bytes.first(bytes.size() - kCrcBytes);
  ByteReader crc(bytes.subspan(body.size()));
  ByteReader reader(body);
  if (reader.Little<std::uint32_t>() != kMagic) return Status::kVersion;
  if (crc.Little<std::uint32_t>() != Crc32(body)) return Status::kCrc;
  const auto flags = reader.Little<std::uint8_t>();
  const auto voxel_mm = reader.Little<std::uint16_t>();
  const auto radius_cm = reader.Little<std::uint16_t>();
  submap->keyframe = reader.Little<std::int32_t>();
  submap->t.ns = reader.Little<std::int64_t>();
  const auto n = reader.Little<std::uint32_t>();
  if (flags > 1 || voxel_mm == 0 || n > submap->points.capacity()) return Status::kBadInput;
  submap->flushed = flags == 1;
  submap->voxel_m = static_cast<float>(voxel_mm) * 0.001F;
  submap->radius_m = static_cast<float>(radius_cm) * 0.01F;

  GridPoint g;
  for (std::uint32_t i = 0; i < n; ++i) {
    std::uint32_t delta = 0;
    for (unsigned shift = 0;; shift += 7) {
      const auto byte = reader.Little<std::uint8_t>();
      if (shift > 21 || reader.failed()) return Status::kBadInput;
      delta |= static_cast<std::uint32_t>(byte & 0x7FU) << shift;
      if ((byte & 0x80U) == 0) break;
    }
    g.cell += delta;
    if (g.cell >= (1U << 24U)) return Status::kBadInput;
    g.offset = reader.Little<std::uint16_t>();
    if (reader.failed()) return Status::kBadInput;
    const Status pushed = submap->points.TryPush(FromGrid(g, submap->voxel_m));
    if (pushed != Status::kOk) return pushed;
  }
  return reader.remaining() == 0 ? Status::kOk : Status::kBadInput;
}

}  // namespace mapweld::submap
