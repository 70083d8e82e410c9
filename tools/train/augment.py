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


def _fewer_beams(points, rng):
    """Keeps bands of elevation, as a sensor with beams 1 to 4 degrees apart would."""
    apart = np.deg2rad(rng.uniform(1, 4))
    elevation = np.arctan2(points[:, 2], np.hypot(points[:, 0], points[:, 1])) / apart + rng.random()
    return np.abs(elevation - np.rint(elevation)) < rng.uniform(0.15, 0.4)


def _thinned_crowns(points, rng):
    """Leaves come and go: above some height most points of some 4 m blocks are lost."""
    block = np.floor(points / 4).astype(int)
    lost = ((block[:, 0] * 73856093) ^ (block[:, 1] * 19349663) ^ int(rng.integers(1 << 30))) % 1000 < 1000 * rng.uniform(0.2, 0.7)
    above = points[:, 2] > np.percentile(points[:, 2], 5) + rng.uniform(1.5, 4)
    return ~(above & lost & (rng.random(len(points)) < 0.8))


def _columns(points, rng):
    """As if made from a bird's-eye density image: 0.4 m cells within 25 to 30 m, as much higher as there was more in them."""
    p = points[_without_ground(points, 0.3) & (np.hypot(points[:, 0], points[:, 1]) < rng.uniform(25, 30))]
    cells, count = np.unique(np.floor(p[:, :2] / 0.4).astype(int), axis=0, return_counts=True)
    height = np.rint(1 + 0.3 * np.minimum(10, 3 * np.log2(1 + count))).astype(int)
    which = np.repeat(np.arange(len(cells)), height)
    level = np.arange(len(which)) - np.repeat(np.cumsum(height) - height, height)
    corner = np.column_stack([cells[which] + 0.5, level - 3]) * 0.4
    return corner + rng.uniform(-0.1, 0.1, corner.shape)


def augment(points, rng):
    """[n, 3] float32 to [m, 3]: any heading, up to 4 m aside, shorter range, no ground, few or short beams, points lost, a
    blind sector, things and leaves gone, vehicles that were not there, heights made up."""
    aside = np.append(rng.normal(0, rng.choice([0.7, 1.7]), 2).clip(-4, 4), rng.normal(0, 0.1))
    p = _turn(points, rng.uniform(0, 2 * np.pi)) + aside.astype(np.float32)
    if rng.random() < 0.15 and len(points) > 1000:
        p = _columns(p, rng)
    keep = rng.random(len(p)) > rng.choice([rng.uniform(0, 0.5), rng.uniform(0.5, 0.8)], p=[0.8, 0.2])
    if rng.random() < 0.4:
        keep &= np.hypot(p[:, 0], p[:, 1]) < rng.uniform(24, 45)
    if rng.random() < 0.35:
        keep &= _without_ground(p, rng.uniform(0.25, 0.5))
    if rng.random() < 0.35:
        keep &= p[:, 2] < np.percentile(p[:, 2], 5) + rng.uniform(1.5, 8)
    if rng.random() < 0.2:
        keep &= _fewer_beams(p, rng)
    if rng.random() < 0.3:
        keep &= _thinned_crowns(p, rng)
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
