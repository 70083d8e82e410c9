// SPDX-License-Identifier: Apache-2.0
// Every choice of the merge that is not fixed by its method, in one place.
#pragma once

#include "tools/merge/registration.hpp"

namespace mapweld::merge {

// Which keyframes of two drives could show the same place.
struct AssociationConfig {
  bool sketches = false;             // compare only those pairs of drives in full whose sketches agree
  int sketch_step = 1;               // keyframes from one sketch of the first drive that is compared to the next
  int min_sketched_keyframes = 24;   // a shorter drive is always compared in full: its mean would hide its places
  double min_sketch_sequence = 5.0;  // robust standard deviations; from here on a pair is compared in full
  double min_sketch_single = 5.5;
  int min_sequence = 4;  // keyframes; shorter lines of matches are left to the single matches
  int max_sequence = 16;
  double min_sequence_score = 3.5;  // robust standard deviations above what unrelated stretches reach
  double min_single_score = 2.0;    // the same for one keyframe
  int max_sequence_matches = 24;    // per pair of drives
  int max_single_matches = 16;      // per pair of drives
};

// Which matches belong together.
struct ZoneConfig {
  int zone_gap = 5;              // keyframes between matches of one zone, at most
  double edge_ratio = 0.8;       // beta of eq. 7
  double edge_slack_m = 5;       // one keyframe spacing: short edges pass by this instead
  double position_slack_m = 10;  // two keyframes of one place are this close
  double yaw_slack_rad = 0.35;   // error of the yaw of one match
  double drift = 0.02;           // of the odometry, m per m
  int ransac_rounds = 100;
  int max_zones = 10;  // per pair of drives, best first
};

// When a pair of submaps shows the same place, and when a pair of drives overlaps.
struct VerifyConfig {
  int seeds_per_zone = 3;       // matches tried before a zone is given up
  double seed_evidence = 0.10;  // of the first loop of a zone; see Registration::Evidence
  double loop_evidence = 0.05;  // of a loop whose pose was predicted by a verified neighbour
  double slide_overlap = 0.58;  // overlap without evidence from which on a pair says nothing: a bare street
  double min_covered_share = 0.25;
  double max_tilt_rad = 0.09;
  double max_jump_m = 3.0;  // between a predicted and a registered pose, plus drift
  double max_jump_rad = 0.09;
  double drift = 0.02;
  double step_m = 10;               // between the loops along an overlap
  int keyframe_stride = 1;          // loops along an overlap are tried at keyframes 0, stride, 2 stride, ...: where
                                    // submaps have to be fetched, all pairs of drives then want the same few
  double near_m = 15;               // keyframes closer than this must agree, or they speak against the overlap
  double reach_m = 30;              // keyframes up to this far apart may add to the evidence
  double min_total_evidence = 0.5;  // sum over the loops of an overlap
  int min_loops = 3;
  double persist_m = 50;            // how far the walk along an overlap goes on without a loop: a look-alike is small
  double max_contradiction = 0.34;  // share of near keyframe pairs that do not fit
  double min_mean_overlap = 0.58;   // over the near keyframe pairs: clearly more must agree than not
  double max_torn_share = 0.3;      // mean over the near keyframe pairs; see Registration::torn_share
  double min_above_look_alikes = 0.04;  // overlap ratio above that of the drives' own other places; see LookAlikes
};

struct WeightConfig {
  double half_weight_overlap_m = 10;  // the shared length with omega = 1/2; C_omega of eq. 9 follows
  double theta = 0.02;                // greatest eigenvalue of the normalised Laplacian that may count as a cluster
  double eigengap = 8;                // how many times as large the next one must be; a line of drives has at most 4
};

struct GraphConfig {
  // Odometry between neighbouring keyframes, standard deviations per 5 m of path.
  double odometry_sigma_m = 0.10;
  double odometry_sigma_yaw_rad = 0.006;
  double odometry_sigma_tilt_rad = 0.002;
  double loop_sigma_m = 0.25;
  double loop_sigma_yaw_rad = 0.008;
  double loop_sigma_tilt_rad = 0.01;
  int max_iterations = 40;
  double min_mean_weight = 0.4;  // of the loops of an overlap; below, the pose graph speaks against it
  int quarantine_after = 3;      // withdrawn overlaps of one drive
};

struct RefineConfig {
  int rounds = 1;
  double near_m = 12;
  double step_m = 5;
};

struct MergeConfig {
  AssociationConfig association;
  ZoneConfig zones;
  RegistrationConfig registration;
  VerifyConfig verify;
  WeightConfig weight;
  GraphConfig graph;
  RefineConfig refine;
  int threads = 0;  // 0: all of the machine; never changes the result
};

}  // namespace mapweld::merge
