#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Merges a real sequence that was cut into six drifting recordings with unknown frames, and checks the outcome.

usage: merge_real_streets.py MAPWELD SHARED_DATA WORK_DIR SEQUENCE. Exit code 77: skipped, the data is not here.
"""
import json
import pathlib
import subprocess
import sys
import time

# Pairs of pieces that drive the same street (data description of the sequences).
TRUE_PAIRS = {"05": [(0, 5), (1, 2), (1, 3), (1, 5)], "02": [(1, 5), (2, 5), (4, 5)]}
MAX_RMSE_M = {"05": 3.0}

mapweld, shared, work, sequence = sys.argv[1:5]
shared, work = pathlib.Path(shared), pathlib.Path(work)
npz, lift_tool = shared / "kitti_bev" / f"{sequence}.npz", shared / "tools" / "lift_bev.py"
if not npz.exists() or not lift_tool.exists():
    print(f"skipped: {npz} is not here")
    sys.exit(77)
try:
    import numpy  # noqa: F401
except ImportError:
    print("skipped: this Python has no numpy")
    sys.exit(77)

cut = pathlib.Path(__file__).parents[1] / "support" / "cut_drives.py"
subprocess.run([sys.executable, cut, npz, lift_tool, work / "pieces"], check=True)
pieces = [work / "pieces" / f"piece_{k}" for k in range(6)]
truth = [argument for piece in pieces for argument in ("--truth", f"{piece.name}={piece / 'truth.tum'}")]
begin = time.monotonic()
subprocess.run([mapweld, "merge", *pieces, "-o", work / "out", *truth], check=True)
print(f"merge: {time.monotonic() - begin:.1f} s")

summary = json.loads((work / "out" / "summary.json").read_text())
overlaps = json.loads((work / "out" / "overlaps.json").read_text())["overlaps"]
groups = [sorted(group["recordings"]) for group in json.loads((work / "out" / "groups.json").read_text())["groups"]]
accepted = {tuple(int(name[-1]) for name in overlap["pair"]) for overlap in overlaps if overlap["verdict"] == "accepted"}
missed = [pair for pair in TRUE_PAIRS[sequence] if pair not in accepted]
# Pieces that follow one another touch at their ends: finding that is right, not finding it is no mistake.
wrong = [pair for pair in sorted(accepted) if pair not in TRUE_PAIRS[sequence] and pair[1] - pair[0] != 1]
print(f"accepted {sorted(accepted)}, missed {missed}, not in the list {wrong}, groups {groups}, rmse {summary['rmse_m']}")
rows = sum(1 for _ in open(work / "out" / "trajectory_piece_0.kitti.txt"))
scans = len(list((pieces[0] / "velodyne").iterdir()))
problems = []
if missed:
    problems.append(f"missed {missed}")
if rows != scans:
    problems.append(f"{rows} merged poses for {scans} scans")
if sequence in MAX_RMSE_M and not summary["rmse_m"]["all"] <= MAX_RMSE_M[sequence]:
    problems.append(f"rmse {summary['rmse_m']['all']:.2f} m > {MAX_RMSE_M[sequence]} m")
print("; ".join(problems) or "ok")
sys.exit(1 if problems else 0)
