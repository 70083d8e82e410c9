#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares simulated scans with real ones of the same kind of sensor and draws the comparison as SVG.

    tools/sim/realism.py --real real/*.bin --simulated out/vehicle_*/velodyne/*.bin --height 1.73 1.85 -o hdl64e.svg

--height: of the sensor above the road, real and simulated, so that heights compare. Every tenth scan is plenty.
Prints one line per measure; a distance between two histograms is half the sum of their differences (0 equal, 1 apart).
"""
import argparse

import numpy as np

from picture import read_cloud

NEAR_M = 2.5  # the vehicle itself


def load(paths, height):
    scans = []
    for path in paths:
        p = read_cloud(path)
        p = p[np.isfinite(p).all(axis=1)]
        r = np.linalg.norm(p, axis=1)
        p = p[(r > NEAR_M) & (r < 100)]
        p[:, 2] += height
        scans.append(p)
    return scans


def histogram(values, edges):
    counts, _ = np.histogram(values, edges)
    return counts / max(counts.sum(), 1)


def voxels(scan, size=0.5, within=50):
    near = scan[np.hypot(scan[:, 0], scan[:, 1]) < within]
    return len(np.unique(np.floor(near / size).astype(np.int64), axis=0))


def planarity(scan, size=1.0, least=8):
    """RMS distance of points to the plane through their voxel: what a registration is left with. Metres, per voxel."""
    keys = np.floor(scan / size).astype(np.int64)
    keys -= keys.min(axis=0)
    span = keys.max(axis=0) + 1
    flat = (keys[:, 0] * span[1] + keys[:, 1]) * span[2] + keys[:, 2]
    order = np.argsort(flat, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(flat[order])) + 1)
    out = []
    for g in groups:
        if len(g) < least:
            continue
        q = scan[g] - scan[g].mean(axis=0)
        out.append(np.sqrt(max(np.linalg.eigvalsh(q.T @ q / len(g))[0], 0)))
    return np.array(out)


def measures(scans, sensor_height):
    every = np.concatenate(scans)
    ranges = np.linalg.norm(every - [0, 0, sensor_height], axis=1)
    elevation = np.degrees(np.arcsin(np.clip((every[:, 2] - sensor_height) / np.maximum(ranges, 1e-6), -1, 1)))
    return {
        "range, m": (ranges, np.arange(0, 101, 2.5)),
        "height above the road, m": (every[:, 2], np.arange(-2, 14.1, 0.4)),
        "elevation of the beam, degrees": (elevation, np.arange(-26, 16.1, 1.0)),
        "distance to the plane of the neighbours, m": (
            np.concatenate([planarity(s) for s in scans[:8]]), np.arange(0, 0.31, 0.01)),
    }


def bars(x0, y0, width, height, title, edges, real, simulated):
    """One panel: the real histogram filled, the simulated one as a line."""
    top = max(real.max(), simulated.max()) * 1.08
    n = len(real)
    x = [x0 + width * i / n for i in range(n + 1)]
    y = lambda share: y0 + height - height * share / top
    step = lambda h: " ".join(f"{x[i]:.1f},{y(h[i]):.1f} {x[i + 1]:.1f},{y(h[i]):.1f}" for i in range(n))
    ticks = "".join(
        f'<text x="{x[i]:.0f}" y="{y0 + height + 16}" text-anchor="middle">{edges[i]:g}</text>'
        for i in range(0, n + 1, max(1, n // 6)))
    return (
        f'<text x="{x0}" y="{y0 - 8}" font-weight="bold">{title}</text>'
        f'<polygon points="{x0},{y0 + height} {step(real)} {x0 + width},{y0 + height}" fill="#9db8d9"/>'
        f'<polyline points="{step(simulated)}" fill="none" stroke="#c8501e" stroke-width="2"/>'
        f'<line x1="{x0}" x2="{x0 + width}" y1="{y0 + height}" y2="{y0 + height}" stroke="#333"/>{ticks}')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--real", nargs="+", required=True)
    parser.add_argument("--simulated", nargs="+", required=True)
    parser.add_argument("--height", nargs=2, type=float, required=True, metavar=("REAL", "SIMULATED"))
    parser.add_argument("--title", default="")
    parser.add_argument("-o", "--out", required=True)
    args = parser.parse_args()
    real = load(args.real, args.height[0])
    simulated = load(args.simulated, args.height[1])
    print(f"{'':44}{'real':>10}{'simulated':>12}")
    for name, of in [("points per scan", len), ("occupied 0.5 m voxels within 50 m", voxels),
                     ("share of points beyond 30 m", lambda s: (np.linalg.norm(s, axis=1) > 30).mean()),
                     ("share of points above 3 m", lambda s: (s[:, 2] > 3).mean())]:
        print(f"{name:44}{np.median([of(s) for s in real]):>10.3g}{np.median([of(s) for s in simulated]):>12.3g}")
    panels = []
    pairs = zip(measures(real, args.height[0]).items(), measures(simulated, args.height[1]).values())
    for i, ((name, (values, edges)), (others, _)) in enumerate(pairs):
        a, b = histogram(values, edges), histogram(others, edges)
        apart = np.abs(a - b).sum() / 2
        print(f"{name:44}{np.median(values):>10.3g}{np.median(others):>12.3g}   histograms {apart:.2f} apart")
        panels.append(bars(50 + i % 2 * 480, 70 + i // 2 * 270, 420, 190, f"{name} ({apart:.2f} apart)", edges, a, b))
    with open(args.out, "w") as out:
        out.write('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 980 600" font-family="sans-serif" font-size="13">'
                  '<rect width="980" height="600" fill="white"/>'
                  f'<text x="50" y="30" font-size="17">{args.title}: real (filled), simulated (line)</text>'
                  + "".join(panels) + "</svg>\n")


if __name__ == "__main__":
    main()
