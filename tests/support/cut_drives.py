#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cuts a sequence of scans with true poses into several recordings, each with odometry drift and a frame of its own.

Input is a bird's-eye sequence (.npz with density and poses) and the tool that lifts it to 3D, both from the shared data
folder. Output: OUT/piece_K/{velodyne/*.bin, poses.txt, times.txt, truth.tum}.
Drift: every step is scaled by a factor drawn once per piece (sigma = drift / 2) and turned by a heading error that walks
at random; after a path L the lateral error has the standard deviation drift * L.
"""
import argparse
import importlib.util
import pathlib

import numpy as np


def rotation(axis_angle):
    angle = np.linalg.norm(axis_angle)
    if angle < 1e-12:
        return np.eye(3)
    k = axis_angle / angle
    k = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def quaternion(r):
    """x, y, z, w"""
    w = np.sqrt(max(0, 1 + np.trace(r))) / 2
    x = np.copysign(np.sqrt(max(0, 1 + r[0, 0] - r[1, 1] - r[2, 2])) / 2, r[2, 1] - r[1, 2])
    y = np.copysign(np.sqrt(max(0, 1 - r[0, 0] + r[1, 1] - r[2, 2])) / 2, r[0, 2] - r[2, 0])
    z = np.copysign(np.sqrt(max(0, 1 - r[0, 0] - r[1, 1] + r[2, 2])) / 2, r[1, 0] - r[0, 1])
    return np.array([x, y, z, w])


def drifted(poses, drift, rng):
    """world_T_lidar [n,3,4] with drift, from the same first pose."""
    length = np.linalg.norm(np.diff(poses[:, :, 3], axis=0), axis=1).sum()
    scale = 1 + rng.normal(0, drift / 2)
    walk = drift * np.sqrt(3 / max(length, 1))  # rad per square root of a metre
    out = [poses[0]]
    for before, after in zip(poses[:-1], poses[1:]):
        step_r = before[:, :3].T @ after[:, :3]
        step_t = before[:, :3].T @ (after[:, 3] - before[:, 3]) * scale
        step_r = rotation([0, 0, rng.normal(0, walk * np.sqrt(np.linalg.norm(step_t)))]) @ step_r
        last = out[-1]
        out.append(np.hstack([last[:, :3] @ step_r, (last[:, :3] @ step_t + last[:, 3])[:, None]]))
    return np.array(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("npz"), parser.add_argument("lift_tool"), parser.add_argument("out")
    parser.add_argument("--pieces", type=int, default=6)
    parser.add_argument("--drift", type=float, default=0.01)
    parser.add_argument("--seed", type=int, default=1)
    a = parser.parse_args()
    spec = importlib.util.spec_from_file_location("lift_bev", a.lift_tool)
    lift_bev = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(lift_bev)
    with np.load(a.npz) as z:
        density, poses = z["density"], z["poses"].reshape(-1, 3, 4)
    rng = np.random.default_rng(a.seed)
    lift_rng = np.random.default_rng(0)
    bounds = np.linspace(0, len(density), a.pieces + 1).astype(int)
    for k in range(a.pieces):
        folder = pathlib.Path(a.out) / f"piece_{k}"
        (folder / "velodyne").mkdir(parents=True, exist_ok=True)
        frames = range(bounds[k], bounds[k + 1])
        for row, i in enumerate(frames):
            lift_bev.lift(density[i], lift_rng, 0.1).tofile(folder / "velodyne" / f"{row:06d}.bin")
        times = np.arange(bounds[k], bounds[k + 1]) * 0.1
        truth = poses[bounds[k]:bounds[k + 1]]
        np.savetxt(folder / "truth.tum", np.array([[t, *p[:, 3], *quaternion(p[:, :3])] for t, p in zip(times, truth)]), fmt="%.6f")
        start_r, start_t = rotation(rng.normal(0, 1, 3) * 2), rng.normal(0, 1000, 3)  # any frame at all
        odometry = drifted(truth, a.drift, rng)
        rows = [np.hstack([start_r @ p[:, :3], (start_r @ p[:, 3] + start_t)[:, None]]).ravel() for p in odometry]
        np.savetxt(folder / "poses.txt", rows, fmt="%.9f")
        np.savetxt(folder / "times.txt", times, fmt="%.6f")


if __name__ == "__main__":
    main()
