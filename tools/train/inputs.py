#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Turns submap sets into what the networks look at, by the agent's own code: inputs.py SET.bin ... -o OUT.npz [--variants 5]

OUT.npz: image uint8 [n, variants, 3 bands, 32 rings, 64 directions] (variant 0 as recorded, the others augmented), drive
int [n], position [n, 3] m, heading [n] rad. With --points also what the paper's networks look at (paper.py): points int16
[n, variants, 4096, 3] cm and panorama uint8 [n, variants, 64, 64]. Submaps that the agent would refuse are left out.
"""
import argparse
import ctypes
import multiprocessing
import os
import pathlib
import sys

import numpy as np

from augment import augment
from submaps import read_submaps

BANDS, RINGS, DIRECTIONS = 3, 32, 64
BOX_M, POINTS = 40, 4096
PANORAMA, REACH_M = 64, 50


def native():
    path = os.environ.get("MAPWELD_TRAIN_LIBRARY") or (
        pathlib.Path(__file__).resolve().parents[2] / "build/release/tools/train/libmapweld_train.so")
    if not pathlib.Path(path).exists():
        sys.exit(f"inputs.py: {path} is missing; build it with: tools/build mapweld_train")
    return ctypes.CDLL(str(path))


LIBRARY = None


def plan_image(points):
    """uint8 [3, 32, 64] of points [n, 3] in metres, level frame; None when the agent would refuse them."""
    global LIBRARY
    LIBRARY = LIBRARY or native()
    points = np.ascontiguousarray(points, np.float32)
    image = np.empty((BANDS, RINGS, DIRECTIONS), np.uint8)
    accepted = LIBRARY.mapweld_plan_image(points.ctypes.data_as(ctypes.c_void_p), len(points),
                                          image.ctypes.data_as(ctypes.c_void_p))
    return image if accepted else None


def box_points(points, rng):
    """int16 [4096, 3] in cm: of the 80 x 80 m around the vehicle, some twice where there are too few."""
    inside = points[np.abs(points[:, :2]).max(1) < BOX_M]
    return np.rint(100 * inside[rng.choice(len(inside), POINTS, len(inside) < POINTS)]).clip(-32767, 32767).astype(np.int16)


def panorama(points):
    """uint8 [64 polar angles, 64 azimuths]: 255 less 5 for each metre of the nearest range within 50 m; 0 without any."""
    range_m = np.linalg.norm(points, axis=1)
    p, r = points[range_m < REACH_M], range_m[range_m < REACH_M]
    row = (np.arccos(np.clip(p[:, 2] / np.maximum(r, 1e-3), -1, 1)) / np.pi * PANORAMA).astype(int).clip(0, PANORAMA - 1)
    column = (np.arctan2(p[:, 1], p[:, 0]) / (2 * np.pi) * PANORAMA).astype(int) % PANORAMA
    far_first = np.argsort(-r)
    image = np.zeros((PANORAMA, PANORAMA), np.uint8)
    image[row[far_first], column[far_first]] = 255 - 5 * r[far_first]
    return image


def view(points, rng, with_points):
    """(image, points, panorama), the latter two None unless asked for; None when the agent would refuse the points."""
    image = plan_image(points)
    if image is None:
        return None
    return (image, box_points(points, rng), panorama(points)) if with_points else (image, None, None)


def variants(job):
    index, drive, submap, arguments = job
    views = []
    for v in range(arguments.variants):
        rng = np.random.default_rng([arguments.seed, index, v])
        tries = (view(augment(submap.points, rng) if v else submap.points, rng, arguments.points)
                 for _ in range(4 if v else 1))  # too little may be left of an augmented one
        views.append(next((made for made in tries if made is not None), views[0] if v else None))
        if views[0] is None:
            return None
    t = submap.world_T_level
    return [None if part[0] is None else np.stack(part) for part in zip(*views)] + [
        drive, t[:, 3], np.arctan2(t[1, 0], t[0, 0])]


def jobs(arguments):
    """Every submap with its number and its drive, drives counted over all files."""
    index, drives = 0, {}
    for path in arguments.sets:
        for submap in read_submaps(path):
            yield index, drives.setdefault((path, submap.drive), len(drives)), submap, arguments
            index += 1


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sets", nargs="+")
    parser.add_argument("-o", "--out", required=True)
    parser.add_argument("--variants", type=int, default=5)
    parser.add_argument("--points", action="store_true")
    parser.add_argument("--processes", type=int, default=None)
    parser.add_argument("--seed", type=int, default=1)
    a = parser.parse_args()
    with multiprocessing.Pool(a.processes) as pool:
        rows = [row for row in pool.imap(variants, jobs(a), chunksize=16) if row is not None]
    if not rows:
        sys.exit(f"inputs.py: {' '.join(a.sets)} hold no submap that the agent would describe")
    columns = dict(zip(("image", "points", "panorama", "drive", "position", "heading"), zip(*rows)))
    whole = pathlib.Path(a.out).with_suffix(".part.npz")
    np.savez(whole, **{name: np.stack(rows) for name, rows in columns.items() if rows[0] is not None})
    whole.rename(a.out)
    print(f"{a.out}: {len(rows)} places, {a.variants} views each")


if __name__ == "__main__":
    main()
