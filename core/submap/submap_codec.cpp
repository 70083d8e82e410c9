// SPDX-License-Identifier: Apache-2.0
#include "core/submap/submap_codec.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/byte_io.hpp"
#include "core/base/crc32.hpp"
#include "core/submap/submap_models.hpp"

namespace mapweld::submap {
namespace {

// header | range-coded octree | CRC-32 of all before
constexpr std::uint32_t kMagic = 0x324D534D;  // "MSM2"
constexpr std::size_t kHeaderBytes = 4 + 1 + 2 + 2 + 4 + 8 + 4;
constexpr std::size_t kCrcBytes = 4;
constexpr auto kSteps = static_cast<float>(1U << kStepBits);

CellContent ToContent(const SubmapPoint& p, float voxel_m) {
  const float v[3] = {p.x / voxel_m, p.y / voxel_m, p.z / voxel_m};
  CellContent content;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const float step = (v[axis] - std::floor(v[axis])) * kSteps;
    content.step[axis] = static_cast<std::uint8_t>(std::min(step, kSteps - 1));
  }
  content.seen_again = p.count > 1;
  return content;
}

SubmapPoint FromContent(std::uint32_t key, const CellContent& content, float voxel_m) {
  float v[3];
  for (unsigned axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::int32_t>(GatherBits(key >> axis)) - kHalfExtent;
    v[axis] = (static_cast<float>(cell) + (static_cast<float>(content.step[axis]) + 0.5F) / kSteps) * voxel_m;
  }
  return {v[0], v[1], v[2], static_cast<std::uint16_t>(content.seen_again ? 2 : 1), 0};
}

// Goes on through the occupied cells in order, the same way for encoder and decoder, until at least max_points more are
// coded: kNotReady then, kOk at the end. The side supplies:
//   Mask(level)                 the occupied children of the node that holds the next point; the decoder knows none
//   Content(), More(key)        the next point; does another one lie in this cell?
//   operator()(bit, model), Even(value, bits)   code and give what holds, see submap_models.hpp
//   Take(key, content)          one point is coded
template <class Side>
Status WalkOctree(std::size_t max_points, SubmapModels* models, OctreeWalk* walk, Side* side) {
  auto& path = walk->path;
  if (!walk->begun) path[0] = {CodeMask(side->Mask(kGridLevels), &models->occupied[kGridLevels - 1][0], *side), 0};
  walk->begun = true;
  std::size_t coded = 0;
  while (true) {
    OctreeWalk::Node& node = path[walk->depth];
    if (node.next == 8) {
      if (walk->depth == 0) return Status::kOk;
      --walk->depth;
      walk->key >>= 3U;
      continue;
    }
    if (coded >= max_points) return Status::kNotReady;
    const unsigned child = node.next++;
    if (((node.mask >> child) & 1U) == 0) continue;
    if (walk->depth + 1 < kGridLevels) {
      const unsigned level = kGridLevels - 1 - walk->depth;
      auto& model = models->occupied[level - 1][NeighboursInParent(node.mask, child)];
      path[++walk->depth] = {CodeMask(side->Mask(level), &model, *side), 0};
      walk->key = (walk->key << 3U) | child;
      if (walk->depth + 1 == kGridLevels) walk->block.Clear();
      continue;
    }
    const std::uint32_t cell = (walk->key << 3U) | child;
    for (bool more = true, first = true; more; first = false) {
      const CellContent content = CodeContent(side->Content(), child, walk->block, models, *side);
      const Status status = side->Take(cell, content);
      if (status != Status::kOk) return status;
      ++coded;
      walk->block.Add(child, content);
      more = (*side)(side->More(cell), &models->more[first ? 0 : 1]);
    }
  }
}

class EncoderSide {
 public:
  EncoderSide(const Submap& submap, std::span<const std::uint32_t> keys, std::size_t* next, RangeEncoder* coder)
      : submap_(submap), keys_(keys), next_(*next), coder_(coder) {}

  bool operator()(bool bit, BitModel* model) const {
    coder_->Put(bit, model);
    return bit;
  }
  std::uint32_t Even(std::uint32_t value, unsigned bits) const {
    coder_->PutEven(value, bits);
    return value;
  }
  [[nodiscard]] std::uint8_t Mask(unsigned level) const {
    const unsigned shift = 3 * level;
    unsigned mask = 0;
    for (std::size_t i = next_; i < keys_.size() && keys_[i] >> shift == keys_[next_] >> shift; ++i) {
      mask |= 1U << ((keys_[i] >> (shift - 3)) & 7U);
    }
    return static_cast<std::uint8_t>(mask);
  }
  [[nodiscard]] CellContent Content() const { return ToContent(submap_.points[next_], submap_.voxel_m); }
  [[nodiscard]] bool More(std::uint32_t cell) const { return next_ < keys_.size() && keys_[next_] == cell; }
  Status Take(std::uint32_t, const CellContent&) {
    ++next_;
    return Status::kOk;
  }

 private:
  const Submap& submap_;
  std::span<const std::uint32_t> keys_;
  std::size_t& next_;
  RangeEncoder* coder_;
};

class DecoderSide {
 public:
  DecoderSide(std::size_t points, RangeDecoder* coder, Submap* submap)
      : points_(points), coder_(coder), submap_(submap) {}

  bool operator()(bool, BitModel* model) const { return coder_->Get(model); }
  std::uint32_t Even(std::uint32_t, unsigned bits) const { return coder_->GetEven(bits); }
  [[nodiscard]] std::uint8_t Mask(unsigned) const { return 0; }
  [[nodiscard]] CellContent Content() const { return {}; }
  [[nodiscard]] bool More(std::uint32_t) const { return false; }
  Status Take(std::uint32_t cell, const CellContent& content) {
    if (submap_->points.size() == points_ || coder_->failed()) return Status::kBadInput;
    return submap_->points.TryPush(FromContent(cell, content, submap_->voxel_m));
  }

 private:
  std::size_t points_;
  RangeDecoder* coder_;
  Submap* submap_;
};

}  // namespace

Status SubmapEncoder::Begin(const Submap& submap, std::span<std::uint8_t> out) {
  ByteWriter writer(out);
  writer.Little(kMagic);
  writer.Little(static_cast<std::uint8_t>(submap.flushed ? 1 : 0));
  writer.Little(static_cast<std::uint16_t>(std::lround(submap.voxel_m * 1000.0F)));
  writer.Little(static_cast<std::uint16_t>(std::lround(submap.radius_m * 100.0F)));
  writer.Little(submap.keyframe);
  writer.Little(submap.t.ns);
  writer.Little(static_cast<std::uint32_t>(submap.points.size()));
  if (writer.failed()) return Status::kFull;
  for (std::size_t i = 0; i < submap.points.size(); ++i) {
    if (!CellKey(submap.points[i], submap.voxel_m, &keys_[i])) return Status::kOutOfRange;
    if (i > 0 && keys_[i] < keys_[i - 1]) return Status::kBadInput;
  }
  out_ = out;
  next_ = 0;
  models_ = {};
  walk_ = {};
  coder_ = RangeEncoder(out.subspan(writer.size()));
  return Status::kOk;
}

Result<std::size_t> SubmapEncoder::Continue(const Submap& submap, std::size_t max_points) {
  std::size_t size = kHeaderBytes;
  if (!submap.points.empty()) {
    EncoderSide side(submap, std::span(keys_).first(submap.points.size()), &next_, &coder_);
    const Status status = WalkOctree(max_points, &models_, &walk_, &side);
    if (status != Status::kOk) return status;  // kNotReady: it cannot fail
    size += coder_.Finish();
    if (coder_.failed()) return Status::kFull;
  }
  ByteWriter crc(out_.subspan(size));
  crc.Little(Crc32(out_.first(size)));
  if (crc.failed()) return Status::kFull;
  return size + kCrcBytes;
}

Result<std::size_t> SubmapEncoder::Encode(const Submap& submap, std::span<std::uint8_t> out) {
  const Status status = Begin(submap, out);
  if (status != Status::kOk) return status;
  return Continue(submap, submap.points.size() + 1);
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
  const auto coded = body.subspan(kHeaderBytes);
  if (n == 0) return coded.empty() ? Status::kOk : Status::kBadInput;

  SubmapModels models;
  RangeDecoder coder(coded);
  DecoderSide side(n, &coder, submap);
  OctreeWalk walk;
  const Status status = WalkOctree(n + 1, &models, &walk, &side);
  if (status != Status::kOk) return status;
  const bool whole = submap->points.size() == n && !coder.failed() && coder.read() == coded.size();
  return whole ? Status::kOk : Status::kBadInput;
}

}  // namespace mapweld::submap
