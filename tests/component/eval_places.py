#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Scores a made-up table of descriptors with `mapweld eval places` and once more with numpy, written from the
definitions in docs/evaluation.md alone: every figure must agree.

usage: eval_places.py MAPWELD WORK_DIR. Exit code 77: skipped, no numpy.
"""
import json
import pathlib
import subprocess
import sys

try:
    import numpy as np
except ImportError:
    print("skipped: this Python has no numpy")
    sys.exit(77)

mapweld, work = sys.argv[1], pathlib.Path(sys.argv[2])
work.mkdir(parents=True, exist_ok=True)
rng = np.random.default_rng(7)


def drive():
    """A square block twice around, then back the other way and once across: all kinds of revisit."""
    corners = np.array([[0, 0], [150, 0], [150, 100], [0, 100]])
    way = [*corners, *corners, corners[0], corners[3], corners[2], corners[1], [75, 0], [75, 100], [75, 140]]
    points = [np.zeros(2)]
    for goal in way:
        while np.linalg.norm(goal - points[-1]) > 1e-9:
            step = goal - points[-1]
            points.append(points[-1] + step * min(1, 5 / np.linalg.norm(step)))
    points = np.array(points) + rng.normal(0, 1, (len(points), 2))
    return np.column_stack([points, 0.01 * points[:, 0]])


def descriptors(positions):
    """Smooth functions of the position with so much noise that a good part of the matches is wrong."""
    waves = rng.normal(0, 0.12, (1024, 2))
    smooth = np.cos(positions[:, :2] @ waves.T + rng.uniform(0, 6, 1024))
    return np.clip(np.rint(smooth * 30 + rng.normal(0, 55, smooth.shape)), -127, 127).astype(int)


def score(positions, d, radius):
    path = np.r_[0, np.cumsum(np.linalg.norm(np.diff(positions, axis=0), axis=1))]
    ahead = np.r_[positions[1:], positions[-1:]][:, :2] - np.r_[positions[:1], positions[:-1]][:, :2]
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    unit = d / np.linalg.norm(d, axis=1, keepdims=True)
    distance = 1 - unit @ unit.T
    metres = np.linalg.norm(positions[:, None] - positions[None], axis=2)
    turn = np.degrees(np.arccos(np.clip(ahead @ ahead.T, -1, 1)))
    kind = np.where(turn < 60, "forward", np.where(turn > 120, "reverse", "crossing"))
    ranks = {"all": [], "forward": [], "reverse": [], "crossing": []}
    best = []
    for q in range(len(positions)):
        candidates = np.flatnonzero(path[q] - path >= 60)
        if len(candidates) == 0:
            continue
        order = candidates[np.argsort(distance[q, candidates], kind="stable")]
        hits = metres[q, order] <= radius
        best.append((distance[q, order[0]], hits[0], hits.any()))
        for view in ranks:
            kept = order if view == "all" else order[(metres[q, order] > 25) | (kind[q, order] == view)]
            hits = metres[q, kept] <= radius
            if hits.any():
                ranks[view].append(int(np.argmax(hits)) + 1)
    best = np.array(sorted(best))
    right, believed = np.cumsum(best[:, 1]), np.arange(1, len(best) + 1)
    precision, recall = right / believed, right / best[:, 2].sum()
    f1 = 2 * precision * recall / np.maximum(precision + recall, 1e-12)
    full = recall[precision == 1]
    return {
        **{view: (len(r), [np.mean(np.array(r) <= n) if r else 0 for n in (1, 5, 10, 20)]) for view, r in ranks.items()},
        "f1_max": f1.max(),
        "extended_precision": (precision[0] + (full.max() if len(full) else 0)) / 2,
        "auc": np.trapz(np.r_[precision[0], precision], np.r_[0, recall]),
    }


positions = drive()
d = descriptors(positions)
table = work / "made_up.csv"
header = ["scan", "x", "y", "z", "scale", *(f"d{i}" for i in range(1024)), *(f"o{i}" for i in range(192))]
rows = [[7 * i, *(f"{v:.4f}" for v in positions[i]), 0.01, *d[i], *([0] * 192)] for i in range(len(positions))]
table.write_text("\n".join(",".join(map(str, row)) for row in [header, *rows]) + "\n")
out = subprocess.run([mapweld, "eval", "places", table, "--json"], check=True, capture_output=True, text=True).stdout
ours = json.loads(out)["descriptors"][0]["radii"]
positions = np.round(positions, 4)

problems = []
for got in ours:
    want = score(positions, d, got["radius_m"])
    for key, value in want.items():
        if isinstance(value, tuple):
            seen = [got[key]["queries"], *(got[key][f"recall_at_{n}"] for n in (1, 5, 10, 20))]
            expected = [value[0], *value[1]]
        else:
            seen, expected = [got[key]], [value]
        agree = np.allclose(seen, expected, atol=1e-5)
        print(f"{got['radius_m']:4} m {key:20} {np.round(seen, 4)} {'' if agree else f'but numpy has {expected}'}")
        if not agree:
            problems.append(f"{key} at {got['radius_m']} m")
if min(ours[1][kind]["queries"] for kind in ("all", "forward", "reverse", "crossing")) < 5:
    problems.append("the made-up drive has too few revisits of some kind to tell anything")
if not 0.2 < ours[1]["all"]["recall_at_1"] < 0.98:
    problems.append("the made-up descriptors are too good or too bad to tell anything")
print("; ".join(problems) or "ok")
sys.exit(1 if problems else 0)
