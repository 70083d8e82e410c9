// SPDX-License-Identifier: Apache-2.0
// What encoder and decoder of a submap both know when they come to a bit: the contexts of its probability.
#pragma once

#include <array>
#include <cstdint>

#include "core/submap/range_coder.hpp"
#include "core/submap/submap_grid.hpp"

namespace mapweld::submap {

inline constexpr unsigned kStepBits = 4;  // the mean of a cell is coded in 1/16 of its edge
inline constexpr unsigned kEvenBits = 2;  // of x and y: the last bits, in which nothing can be foreseen

// The mean inside a cell, in steps, and whether more than one return made it.
struct CellContent {
  std::array<std::uint8_t, 3> step{};
  bool seen_again = false;
};

// The cells of one 2 x 2 x 2 block that are already coded. Surfaces go on: a wall has the same x or y one cell higher
// or along itself, the ground the same z one cell on.
class CodedBlock {
 public:
  void Clear() { known_ = 0; }
  void Add(unsigned child, const CellContent& content) {
    known_ |= 1U << child;
    content_[child] = content;
  }
  // The step expected on this axis, or kNoGuess.
  static constexpr unsigned kNoGuess = 1U << kStepBits;
  [[nodiscard]] unsigned Guess(unsigned child, unsigned axis) const {
    static constexpr unsigned kLookAlong[3][2] = {{4, 2}, {4, 1}, {1, 2}};  // child bits: x 1, y 2, z 4
    for (const unsigned bit : kLookAlong[axis]) {
      const unsigned other = child ^ bit;
      if ((known_ & (1U << other)) != 0) return content_[other].step[axis];
    }
    return kNoGuess;
  }
  // 0: nothing known of the neighbours, 1: seen once, 2: seen again.
  [[nodiscard]] unsigned GuessSeen(unsigned child) const {
    for (const unsigned bit : {1U, 2U, 4U}) {
      const unsigned other = child ^ bit;
      if ((known_ & (1U << other)) != 0) return content_[other].seen_again ? 2 : 1;
    }
    return 0;
  }

 private:
  unsigned known_ = 0;
  std::array<CellContent, 8> content_{};
};

// Where encoder and decoder are in the octree.
struct OctreeWalk {
  // A node on the way down. Level 8 is the root; a child of a level-1 node is a cell.
  struct Node {
    std::uint8_t mask = 0;  // occupied children
    std::uint8_t next = 0;  // child to visit next
  };
  std::array<Node, kGridLevels> path;
  std::uint32_t key = 0;
  unsigned depth = 0;
  bool begun = false;
  CodedBlock block;
};

struct SubmapModels {
  // Occupancy of a node's eight children: by level, by which of the node's own neighbours in its parent (x, y, z) are
  // occupied, and by the bits of this mask coded before, as the path in a binary tree.
  std::array<std::array<std::array<BitModel, 256>, 8>, kGridLevels> occupied;
  std::array<BitModel, 2> more;  // another point in the same cell; after a first, after others
  std::array<std::array<std::array<BitModel, 1U << kStepBits>, CodedBlock::kNoGuess + 1>, 3> step;  // axis, guess, path
  std::array<BitModel, 3> seen_again;
};

// `code` is the encoder's or the decoder's side: code(bit, model) and code.Even(value, bits) take what the encoder
// knows and give what holds.
template <class Code>
std::uint8_t CodeMask(std::uint8_t mask, std::array<BitModel, 256>* models, const Code& code) {
  unsigned path = 1;
  unsigned out = 0;
  for (unsigned child = 0; child < 8; ++child) {
    if (child == 7 && out == 0) return 0x80;  // a node that exists has a child
    const bool bit = code(((mask >> child) & 1U) != 0, &(*models)[path]);
    path = (path << 1U) | (bit ? 1U : 0U);
    out |= (bit ? 1U : 0U) << child;
  }
  return static_cast<std::uint8_t>(out);
}

template <class Code>
CellContent CodeContent(const CellContent& content, unsigned child, const CodedBlock& block, SubmapModels* models,
                        const Code& code) {
  CellContent out;
  for (unsigned axis = 0; axis < 3; ++axis) {
    auto& tree = models->step[axis][block.Guess(child, axis)];
    unsigned path = 1;
    const unsigned even = axis == 2 ? 0 : kEvenBits;
    for (unsigned bit = kStepBits; bit-- > even;) {
      path = (path << 1U) | (code(((content.step[axis] >> bit) & 1U) != 0, &tree[path]) ? 1U : 0U);
    }
    out.step[axis] = static_cast<std::uint8_t>((path << even) & ((1U << kStepBits) - 1));
  }
  constexpr unsigned kEvenMask = (1U << kEvenBits) - 1;
  const unsigned rest =
      code.Even(((content.step[0] & kEvenMask) << kEvenBits) | (content.step[1] & kEvenMask), 2 * kEvenBits);
  out.step[0] = static_cast<std::uint8_t>(out.step[0] | (rest >> kEvenBits));
  out.step[1] = static_cast<std::uint8_t>(out.step[1] | (rest & kEvenMask));
  out.seen_again = code(content.seen_again, &models->seen_again[block.GuessSeen(child)]);
  return out;
}

// Which neighbours inside its parent does this child have? Bits x 1, y 2, z 4.
inline unsigned NeighboursInParent(std::uint8_t parent_mask, unsigned child) {
  unsigned neighbours = 0;
  for (const unsigned bit : {1U, 2U, 4U}) {
    if (((parent_mask >> (child ^ bit)) & 1U) != 0) neighbours |= bit;
  }
  return neighbours;
}

}  // namespace mapweld::submap
