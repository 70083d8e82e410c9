# SPDX-License-Identifier: Apache-2.0
"""The same place as another vehicle, another sensor or another day would see it."""
import numpy as np


def _turn(points, angle):
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]], np.float32)


def _without_ground(points, height):
    cell = (np.floor(points[:, 0] / 2) + 64).astype(int) * 256 + (np.floor(points[:, 1] / 2) + 64).astype(int)
    lowest = np.full(65536, np.inf, np.float32)
    np.minimum.at(lowest, cell, points[:, 2])
    return points[:, 2] - lowest[cell] > height


def _vehicle(rng):
    """A box of 4.4 x 1.8 x 1.4 m somewhere within 25 m, seen from its sides."""
    n = rng.integers(10, 60)
    surface = rng.uniform(-1, 1, (n, 3)).astype(np.float32) * [2.2, 0.9, 0.7]
    side = rng.integers(0, 2, n)
    surface[np.arange(n), side] = np.sign(surface[np.arange(n), side]) * np.array([2.2, 0.9])[side]
    return _turn(surface, rng.uniform(0, np.pi)) + np.append(rng.uniform(-25, 25, 2), -0.5)


def augment(points, rng):
    """[n, 3] float32 to [m, 3]: any heading, about a metre aside, shorter range, no ground, few or short beams, up to half
    of the points lost, a blind sector, things gone and vehicles that were not there."""
    p = _turn(points, rng.uniform(0, 2 * np.pi)) + np.append(rng.normal(0, 1, 2), rng.normal(0, 0.1)).astype(np.float32)
    keep = rng.random(len(p)) > rng.uniform(0, 0.5)
    if rng.random() < 0.4:
        keep &= np.hypot(p[:, 0], p[:, 1]) < rng.uniform(24, 45)
    if rng.random() < 0.35:
        keep &= _without_ground(p, rng.uniform(0.25, 0.5))
    if rng.random() < 0.35:
        keep &= p[:, 2] < np.percentile(p[:, 2], 5) + rng.uniform(1.5, 8)
    if rng.random() < 0.3:
        off = (np.arctan2(p[:, 1], p[:, 0]) - rng.uniform(-np.pi, np.pi) + np.pi) % (2 * np.pi) - np.pi
        keep &= np.abs(off) > rng.uniform(0.15, 0.75)
    for _ in range(rng.integers(0, 8)):
        centre, half = rng.uniform(-35, 35, 2), rng.uniform(1.5, 6)
        keep &= np.abs(p[:, :2] - centre).max(1) > half
    p = p[keep]
    if rng.random() < 0.4:
        p = p + rng.normal(0, rng.uniform(0.02, 0.12), p.shape)
    vehicles = [_vehicle(rng) for _ in range(rng.integers(0, 6))]
    return np.concatenate([p] + vehicles).astype(np.float32)
