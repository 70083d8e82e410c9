#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Turns submap sets into what the network looks at, by the agent's own code: inputs.py SET.bin OUT.npz [--variants 3]

OUT.npz: image uint8 [n, variants, 3 bands, 32 rings, 64 directions] (variant 0 as recorded, the others augmented), drive
int [n], position [n, 3] m, heading [n] rad. Submaps that the agent would refuse are left out.
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


def variants(job):
    index, submap, count, seed = job
    images = [plan_image(submap.points)]
    for v in range(1, count):
        rng = np.random.default_rng([seed, index, v])
        tries = (plan_image(augment(submap.points, rng)) for _ in range(4))  # too little may be left of one
        images.append(next((image for image in tries if image is not None), images[0]))
    if images[0] is None:
        return None
    t = submap.world_T_level
    return np.stack(images), submap.drive, t[:, 3], np.arctan2(t[1, 0], t[0, 0])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("set")
    parser.add_argument("out")
    parser.add_argument("--variants", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    a = parser.parse_args()
    jobs = ((i, s, a.variants, a.seed) for i, s in enumerate(read_submaps(a.set)))
    with multiprocessing.Pool() as pool:
        rows = [row for row in pool.imap(variants, jobs, chunksize=32) if row is not None]
    if not rows:
        sys.exit(f"inputs.py: {a.set} holds no submap that the agent would describe")
    image, drive, position, heading = zip(*rows)
    np.savez(a.out, image=np.stack(image), drive=np.array(drive), position=np.stack(position), heading=np.array(heading))
    print(f"{a.out}: {len(rows)} places, {a.variants} views each")


if __name__ == "__main__":
    main()
