#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares simulated scans with real ones of the same kind of sensor: numbers as a table, histograms as SVG and PNG.

    tools/sim/realism.py --lidar hdl64e --real DRIVE --simulated OUT/vehicle_1 ... -o hdl64e
    tools/sim/realism.py --lidar vlp16 --indoors --real scan.pcd --simulated OUT/vehicle_1 -o vlp16

A DRIVE is a folder with velodyne/*.bin and a poses.txt or poses_icp.txt of one row (a 3 x 4 pose) per scan, as KITTI odometry
and `mapweld sim --layout kitti` have them; a single .bin or .pcd has no poses and is measured alone. Simulated clouds are
de-skewed and in the frame of the body: --origin says where the sensor sits in it. Real clouds are taken as they are: at a
constant speed two consecutive ones are stretched alike. docs/realism.md.
"""
import argparse
import pathlib

import numpy as np

from picture import read_cloud, read_poses, thinned

TURN_S = 0.1
NEAR_M, FAR_M = 2.5, 100.0  # nearer: the vehicle itself
BEAMS_DEG = {
    "vlp16": np.arange(15.0, -16.0, -2.0),
    "hdl32e": np.arange(32, 0, -1) * 4 / 3 - 32.0,
    "hdl64e": np.r_[2 - np.arange(32) / 3, -8.83 - np.arange(32) / 2],
}
REAL, SIMULATED = "#7f9fc6", "#c8501e"


def rotation(vector):
    """3 x 3 of a rotation vector."""
    angle = np.linalg.norm(vector)
    x, y, z = vector / max(angle, 1e-12)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def rotation_vector(r):
    angle = np.arccos(np.clip((np.trace(r) - 1) / 2, -1, 1))
    axis = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    return axis * (0.5 if angle < 1e-6 else angle / (2 * np.sin(angle)))


def share_of_turn(points, first_deg):
    """When within a turn each point was seen, 0 to 1, by its azimuth. The sensor turns clockwise."""
    return np.mod(first_deg - np.degrees(np.arctan2(points[:, 1], points[:, 0])), 360) / 360


def moved(points, share, turn, step):
    """Every point moved by its share of a motion (rotation vector, translation), to first order in the rotation."""
    return points + share[:, None] * (np.cross(turn, points) + step)


class Drive:
    """Scans of one drive in the frame of the sensor: `scans` at the turn's beginning, `seen` from where each point was seen."""

    def __init__(self, source, origin=None):
        source = pathlib.Path(source)
        files = sorted((source / "velodyne").glob("*.bin")) if source.is_dir() else [source]
        if not files:
            raise SystemExit(f"{source}: no velodyne/*.bin")
        self.poses = None
        for name in ("poses.txt", "poses_icp.txt"):
            if source.is_dir() and self.poses is None and (source / name).exists():
                self.poses = read_poses(str(source / name))
        if self.poses is not None and len(self.poses) != len(files):
            raise SystemExit(f"{source}: {len(files)} scans, {len(self.poses)} poses")
        self.scans = [read(path, np.zeros(3) if origin is None else origin) for path in files]
        self.seen = self.scans
        if origin is not None and self.poses is not None and len(files) > 1:
            self.poses[:, :, 3] += self.poses[:, :, :3] @ origin
            times = np.loadtxt(source / "times.txt")
            self.seen = [self.swept(k, TURN_S / (times[b] - times[b - 1]))
                         for k in range(len(files)) for b in [max(k, 1)]]

    def motion(self, a, b):
        """Pose of scan b in the frame of scan a: rotation, translation."""
        r = self.poses[a][:, :3].T
        return r @ self.poses[b][:, :3], r @ (self.poses[b][:, 3] - self.poses[a][:, 3])

    def swept(self, k, turns):
        """Scan k as the moving sensor saw it, `turns` of it per step from one scan to the next."""
        b = max(k, 1)
        r, t = self.motion(b - 1, b)
        scan = self.scans[k]
        first_deg = np.degrees(np.arctan2(scan[0, 1], scan[0, 0]))
        seen = scan
        for _ in range(2):  # when a point was seen depends on where it was seen
            seen = moved(scan, -share_of_turn(seen, first_deg), rotation_vector(r) * turns, t * turns)
        return seen


def read(path, origin):
    p = read_cloud(str(path)) - origin
    p = p[np.isfinite(p).all(axis=1)]
    r = np.linalg.norm(p, axis=1)
    return p[(r > NEAR_M) & (r < FAR_M)]


def ground(scan):
    """Height of the road below the sensor, metres: the most frequent height within 15 m."""
    near = scan[np.hypot(scan[:, 0], scan[:, 1]) < 15, 2]
    counts, edges = np.histogram(near, np.arange(-4, 0.5, 0.05))
    return edges[counts.argmax()] + 0.025


def voxels(points, size=0.5, within=50):
    """Number of occupied voxels."""
    near = points[np.hypot(points[:, 0], points[:, 1]) < within]
    return len(np.unique(np.floor(near / size).astype(np.int64), axis=0))


def planarity(scan, size=1.0, least=8):
    """Per voxel of `size`: RMS distance of its points to the plane through them, metres. Noise, twigs, edges."""
    keys = np.floor(scan / size).astype(np.int64)
    keys -= keys.min(axis=0)
    span = keys.max(axis=0) + 1
    flat = (keys[:, 0] * span[1] + keys[:, 1]) * span[2] + keys[:, 2]
    order = np.argsort(flat, kind="stable")
    starts = np.flatnonzero(np.r_[True, np.diff(flat[order]) != 0])
    counts = np.diff(np.r_[starts, len(order)])
    p = scan[order] - np.repeat(np.add.reduceat(scan[order], starts) / counts[:, None], counts, axis=0)
    moments = np.add.reduceat(p[:, :, None] * p[:, None, :], starts) / counts[:, None, None]
    return np.sqrt(np.maximum(np.linalg.eigvalsh(moments[counts >= least])[:, 0], 0))


def beam_of(seen, beams_deg):
    """Which beam each point of one scan is of: by the order of the file where that is beam after beam, each once around
    (KITTI), else by the nearest nominal elevation."""
    azimuth = np.arctan2(seen[:, 1], seen[:, 0])
    beam = np.r_[0, np.cumsum((azimuth[:-1] < 0) & (azimuth[1:] >= 0) & (azimuth[1:] - azimuth[:-1] < np.pi))]
    if beam[-1] + 1 == len(beams_deg):
        return beam
    elevation = np.degrees(np.arcsin(seen[:, 2] / np.linalg.norm(seen, axis=1)))
    return np.abs(elevation[:, None] - beams_deg).argmin(axis=1)


def per_beam(seen, beams_deg):
    """Points of each beam of one scan."""
    return np.bincount(beam_of(seen, beams_deg), minlength=len(beams_deg))


def shot_noise(seen, beams_deg, road, least, most):
    """What three neighbouring shots of one beam are off a straight line, metres of range: |a - 2 b + c| / sqrt(6).

    A median of 0.67 s of it means that shots err by a standard deviation of s. Of shots `least` to `most` metres away, on the
    road, that is within 0.3 m of the height `road`; None: on whatever changes by less than 0.15 m from shot to shot.
    """
    r = np.linalg.norm(seen, axis=1)
    beam = beam_of(seen, beams_deg)
    order = np.argsort(beam, kind="stable")  # shots of one beam, as they were fired
    azimuth = np.degrees(np.arctan2(seen[order, 1], seen[order, 0]))
    wanted = (r > least) & (r < most)
    if road is not None:
        wanted &= np.abs(seen[:, 2] - road) < 0.3
    wanted, r = wanted[order], r[order]
    step = np.abs(np.mod(np.diff(azimuth) + 180, 360) - 180)
    smooth = np.abs(np.diff(r)) < (0.15 if road is None else 0.5)
    joined = (np.diff(beam[order]) == 0) & (step < 0.45) & smooth & wanted[1:] & wanted[:-1]
    return (np.abs(r[:-2] - 2 * r[1:-1] + r[2:]) / np.sqrt(6))[joined[1:] & joined[:-1]]


def residuals(fixed, moving, guess_r, guess_t, turns=12, within=40.0, reach=1.0):
    """Distances of `moving` to the planes through `fixed`, metres, once registered (point to plane, from the guess on).

    Second value: share of the points that have a plane within `reach`. A plane: 10 neighbours of a cloud thinned to 0.2 m.
    """
    from scipy.spatial import cKDTree
    fixed = thinned(fixed[np.linalg.norm(fixed, axis=1) < within], 0.2)
    moving = thinned(moving[np.linalg.norm(moving, axis=1) < within], 1.0)
    tree = cKDTree(fixed)
    r, t = guess_r, guess_t
    for _ in range(turns):
        at = moving @ r.T + t
        distance, index = tree.query(at, k=10, distance_upper_bound=reach)
        whole = np.isfinite(distance).all(axis=1)
        near = fixed[index[whole]]
        middle = near.mean(axis=1)
        q = near - middle[:, None]
        values, vectors = np.linalg.eigh(np.einsum("nki,nkj->nij", q, q) / q.shape[1])
        # A plane, not a line of one beam (whose normal would be anything), and no bush.
        plane = (values[:, 1] > 0.05**2) & (values[:, 0] < 0.1 * values[:, 1])
        normal, p = vectors[plane, :, 0], at[whole][plane]
        error = np.einsum("ni,ni->n", normal, p - middle[plane])
        weight = 1 / np.maximum(np.abs(error) / 0.05, 1)  # Huber
        jacobian = np.c_[np.cross(p, normal), normal]
        change = np.linalg.solve(jacobian.T @ (weight[:, None] * jacobian) + 1e-6 * np.eye(6),
                                 -jacobian.T @ (weight * error))
        turn = rotation(change[:3])
        r, t = turn @ r, turn @ t + change[3:]
    return np.abs(error), plane.sum() / len(moving)


def consecutive(drive, most=8):
    """Residuals of pairs of consecutive scans, at most `most` pairs spread over the drive."""
    if drive.poses is None or len(drive.scans) < 2:
        return np.array([]), np.array([])
    all_errors, shares = [], []
    for k in np.unique(np.linspace(0, len(drive.scans) - 2, most).astype(int)):
        errors, share = residuals(drive.scans[k], drive.scans[k + 1], *drive.motion(k, k + 1))
        all_errors.append(errors)
        shares.append(share)
    return np.concatenate(all_errors), np.array(shares)


def submaps(drive, length_m=50.0):
    """Clouds of the scans along `length_m` of path, each in the frame of its last scan, one after another."""
    if drive.poses is None:
        return []
    out, begin, path = [], 0, 0.0
    for k in range(1, len(drive.scans)):
        if k == begin:
            continue
        path += np.linalg.norm(drive.poses[k][:, 3] - drive.poses[k - 1][:, 3])
        if path < length_m - 1.5:  # the spacing of the scans
            continue
        last = drive.poses[k]
        parts = [(drive.scans[i] @ drive.poses[i][:, :3].T + drive.poses[i][:, 3] - last[:, 3]) @ last[:, :3]
                 for i in range(begin, k + 1)]
        out.append(np.concatenate(parts))
        begin, path = k + 1, 0.0
    return out


def measure(drives, beams_deg, indoors=False):
    """All that is compared, of the drives together."""
    where = (NEAR_M, 8) if indoors else (8, 15)
    scans = [s for d in drives for s in d.scans]
    seen = [s for d in drives for s in d.seen]
    heights = [s[:, 2] - ground(s) for s in scans]
    ranges = [np.linalg.norm(s, axis=1) for s in seen]
    pairs = [consecutive(d) for d in drives]
    some = scans[::max(1, len(scans) // 20)]
    return {
        "points per scan": np.array([len(s) for s in seen]),
        "occupied 0.5 m voxels of a scan": np.array([voxels(s) for s in some]),
        "occupied 0.5 m voxels of a 50 m submap": np.array([voxels(m) for d in drives for m in submaps(d)]),
        "share of points beyond 30 m": np.array([(r > 30).mean() for r in ranges]),
        "share of points above 3 m": np.array([(h > 3).mean() for h in heights]),
        "per beam": np.mean([per_beam(s, beams_deg) for s in seen], axis=0),
        "range": np.concatenate(ranges),
        "height": np.concatenate(heights),
        "planarity": np.concatenate([planarity(s) for s in some]),
        "shot noise": np.concatenate([shot_noise(s, beams_deg, None if indoors else ground(s), *where) for s in seen]),
        "residual": np.concatenate([e for e, _ in pairs]),
        "share of points with a plane in the next scan": np.concatenate([s for _, s in pairs]),
    }


def share(values, edges):
    counts, _ = np.histogram(values, edges)
    return counts / max(counts.sum(), 1)


def apart(a, b):
    """Half the sum of the differences of two histograms: 0 the same, 1 nothing in common."""
    return np.abs(a - b).sum() / 2


HISTOGRAMS = {  # name, edges
    "range": ("range, m", np.arange(0, 100.1, 2.0)),
    "height": ("height above the road, m", np.arange(-1, 12.1, 0.25)),
    "planarity": ("off the plane of their 1 m voxel (RMS), m", np.arange(0, 0.201, 0.005)),
    "shot noise": ("noise of one shot, m", np.arange(0, 0.151, 0.005)),
    "residual": ("off the planes of the scan before, m", np.arange(0, 0.201, 0.005)),
}
SINGLES = ["points per scan", "occupied 0.5 m voxels of a scan", "occupied 0.5 m voxels of a 50 m submap",
           "share of points beyond 30 m", "share of points above 3 m", "share of points with a plane in the next scan"]


def table(real, simulated):
    """Markdown: medians and extremes, and how far the histograms are apart."""
    def of(values):
        if len(values) == 0:
            return "-"
        return f"{np.median(values):.3g} ({values.min():.3g} to {values.max():.3g})"

    rows = ["| per scan, submap or pair: median (least to most) | real | simulated |", "|---|---|---|"]
    rows += [f"| {name} | {of(real[name])} | {of(simulated[name])} |" for name in SINGLES]
    rows += ["", "| all points: median, 90th percentile | real | simulated | histograms apart |", "|---|---|---|---|"]
    for key, (name, edges) in HISTOGRAMS.items():
        if len(real[key]) == 0 or len(simulated[key]) == 0:
            continue
        a, b = ("{:.3g}, {:.3g}".format(*np.percentile(m[key], [50, 90])) for m in (real, simulated))
        rows.append(f"| {name} | {a} | {b} | {apart(share(real[key], edges), share(simulated[key], edges)):.2f} |")
    a, b = (m["per beam"] / m["per beam"].sum() for m in (real, simulated))
    rows.append(f"| points per beam | | | {apart(a, b):.2f} |")
    return "\n".join(rows)


def plot(real, simulated, beams_deg, title, out):
    """Writes `out`.svg and `out`.png."""
    import matplotlib
    matplotlib.use("Agg")
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "mapweld", "font.size": 9, "axes.titlesize": 9.5})
    import matplotlib.pyplot as plt
    panels = [k for k in HISTOGRAMS if len(real[k]) and len(simulated[k])]
    counts = [k for k in SINGLES[:3] if len(real[k]) and len(simulated[k])]
    across = 3 if len(panels) < 5 else 4
    rows = -(-(len(panels) + 2) // across)
    figure, axes = plt.subplots(rows, across, figsize=(3.75 * across, 2.7 * rows + 0.3))
    axes = list(axes.flat)
    for key in panels:
        ax = axes.pop(0)
        name, edges = HISTOGRAMS[key]
        a, b = share(real[key], edges), share(simulated[key], edges)
        ax.stairs(a, edges, fill=True, color=REAL, label="real")
        ax.stairs(b, edges, color=SIMULATED, linewidth=1.6, label="simulated")
        ax.set_title(f"{name}: {apart(a, b):.2f} apart", loc="left")
        ax.set_xlim(edges[0], edges[-1])
    figure.axes[0].legend(frameon=False)
    ax = axes.pop(0)
    order = np.argsort(beams_deg)
    ax.fill_between(beams_deg[order], real["per beam"][order], step="mid", color=REAL)
    ax.step(beams_deg[order], simulated["per beam"][order], where="mid", color=SIMULATED, linewidth=1.6)
    ax.set_title("points per beam, over its elevation in degrees", loc="left")
    ax.set_xlim(beams_deg.min(), beams_deg.max())
    ax.set_ylim(0)
    ax = axes.pop(0)
    for i, key in enumerate(counts):
        for values, colour, dy in ((real[key], REAL, 0.15), (simulated[key], SIMULATED, -0.15)):
            ax.plot(values, np.full(len(values), -i + dy), ".", color=colour, alpha=0.4, markersize=5, markeredgewidth=0)
            ax.plot(np.median(values), -i + dy, "|", color=colour, markersize=16, markeredgewidth=2.5)
        ax.text(0.02, -i + 0.32, key, transform=ax.get_yaxis_transform(), fontsize=8.5)
    ax.set_title("each scan or submap, and their median", loc="left")
    ax.set_yticks([])
    ax.set_ylim(-len(counts) + 0.5, 0.6)
    ax.set_xscale("log")
    for rest in axes:
        rest.set_axis_off()
    for ax in figure.axes:
        ax.spines[["top", "right"]].set_visible(False)
    figure.suptitle(title, fontsize=11)
    figure.tight_layout()
    figure.savefig(f"{out}.svg", metadata={"Date": None})
    figure.savefig(f"{out}.png", dpi=90, metadata={"Software": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lidar", choices=sorted(BEAMS_DEG), required=True)
    parser.add_argument("--real", nargs="+", required=True, metavar="DRIVE")
    parser.add_argument("--simulated", nargs="+", required=True, metavar="DRIVE")
    parser.add_argument("--origin", nargs=3, type=float, default=(0.10, 0, 0.35), metavar=("X", "Y", "Z"))
    parser.add_argument("--indoors", action="store_true",
                        help="the real scans see no road: noise is that of whatever is smooth and within 8 m")
    parser.add_argument("--title", default="")
    parser.add_argument("-o", "--out", required=True, help="without its ending: .svg and .png")
    args = parser.parse_args()
    beams_deg = BEAMS_DEG[args.lidar]
    real = measure([Drive(d) for d in args.real], beams_deg, args.indoors)
    simulated = measure([Drive(d, np.array(args.origin)) for d in args.simulated], beams_deg, args.indoors)
    print(table(real, simulated))
    plot(real, simulated, beams_deg, args.title, args.out)


if __name__ == "__main__":
    main()
