// SPDX-License-Identifier: Apache-2.0
#include "tools/ranks/result_codec.hpp"

#include <stdexcept>
#include <type_traits>
#include <utility>

#include "tools/store/record_archive.hpp"

namespace mapweld::ranks {
namespace {

using store::Bytes;
using store::kPoseBytes;
using store::VisitList;
using store::VisitOverlap;
using store::VisitPose;

template <class Archive, class T>
void VisitAssociation(Archive& io, T& association) {
  VisitList(io, association.matches, 19, [&](auto& match) {
    io(match.a);
    io(match.b);
    io(match.score);
    io(match.reverse);
    io(match.sequence);
    io(match.ends);
  });
  io(association.evidence.sequence);
  io(association.evidence.single);
  io(association.compared);
}

// A map has no elements to write into while it is read.
template <class Archive, class T>
void VisitAsked(Archive& io, T& asked) {
  std::vector<std::pair<merge::SubmapKey, bool>> list(asked.begin(), asked.end());
  VisitList(io, list, 9, [&](auto& entry) {
    io(entry.first.drive);
    io(entry.first.keyframe);
    io(entry.second);
  });
  if constexpr (Archive::kReads) asked = {list.begin(), list.end()};
}

template <class Archive, class T>
void VisitOutcome(Archive& io, T& outcome) {
  VisitOverlap(io, outcome.overlap);
  io(outcome.proposed);
  io(outcome.evidence);
  VisitAsked(io, outcome.asked);
}

template <class Archive, class T>
void VisitRefinement(Archive& io, T& refinement) {
  VisitList(io, refinement.loops, kPoseBytes, [&](auto& loop) {
    io(loop.a);
    io(loop.b);
    VisitPose(io, loop.a_T_b);
    io(loop.evidence);
    io(loop.overlap_ratio);
    io(loop.residual_m);
    io(loop.torn_share);
  });
  io(refinement.contradictions);
  io(refinement.evidence);
  VisitAsked(io, refinement.asked);
}

template <class Archive, class T>
void VisitSolution(Archive& io, T& solution) {
  VisitList(io, solution.merged_T_body, 4,
            [&](auto& poses) { VisitList(io, poses, kPoseBytes, [&](auto& pose) { VisitPose(io, pose); }); });
  VisitList(io, solution.loop_weight, 8, [&](auto& weight) { io(weight); });
}

template <class T, class Visit>
void ReadOrThrow(std::span<const std::uint8_t> bytes, T* out, const Visit& visit) {
  if (!store::Read(bytes, out, visit)) throw std::runtime_error("a rank sent a result that cannot be read");
}

const auto kAssociations = [](auto& io, auto& list) {
  VisitList(io, list, 18, [&](auto& association) { VisitAssociation(io, association); });
};
const auto kOutcome = [](auto& io, auto& outcome) { VisitOutcome(io, outcome); };
const auto kRefinement = [](auto& io, auto& refinement) { VisitRefinement(io, refinement); };
const auto kSolution = [](auto& io, auto& solution) { VisitSolution(io, solution); };
const auto kResults = [](auto& io, auto& results) {
  VisitList(io, results, 4, [&](auto& bytes) {
    if constexpr (std::remove_reference_t<decltype(io)>::kReads) {
      bytes.resize(io.Count(1));
    } else {
      io.Count(bytes.size());
    }
    io.Raw(bytes.data(), bytes.size());
  });
};

}  // namespace

Bytes Encode(const std::vector<merge::Association>& associations) {
  return store::Write(associations, kAssociations);
}
Bytes Encode(const merge::PairOutcome& outcome) {
  return store::Write(outcome, kOutcome);
}
Bytes Encode(const merge::PairRefinement& refinement) {
  return store::Write(refinement, kRefinement);
}
Bytes Encode(const merge::GroupSolution& solution) {
  return store::Write(solution, kSolution);
}

void Decode(std::span<const std::uint8_t> bytes, std::vector<merge::Association>* out) {
  ReadOrThrow(bytes, out, kAssociations);
}
void Decode(std::span<const std::uint8_t> bytes, merge::PairOutcome* out) {
  ReadOrThrow(bytes, out, kOutcome);
}
void Decode(std::span<const std::uint8_t> bytes, merge::PairRefinement* out) {
  ReadOrThrow(bytes, out, kRefinement);
}
void Decode(std::span<const std::uint8_t> bytes, merge::GroupSolution* out) {
  ReadOrThrow(bytes, out, kSolution);
}

Bytes Pack(const std::vector<Bytes>& results) {
  return store::Write(results, kResults);
}
std::vector<Bytes> Unpack(std::span<const std::uint8_t> bytes) {
  std::vector<Bytes> out;
  ReadOrThrow(bytes, &out, kResults);
  return out;
}

}  // namespace mapweld::ranks
