# SPDX-License-Identifier: Apache-2.0
"""Three small recordings of one street, for tests of whole programs, and what of a merge must always be the same."""
import numpy

STEP_M, RANGE_M = 2.0, 30.0


def town(rng):
    """Points of the walls along a street of 260 m."""
    points = []
    for side in (-1, 1):
        x = rng.uniform(0, 6)
        while x < 260:
            width, depth, setback, height = rng.uniform([6, 5, 6, 3], [16, 12, 12, 9])
            for z in numpy.arange(0.1, height, 0.6):
                for y in (setback, setback + depth):
                    along = numpy.arange(x, x + width, 0.6)
                    points.append(numpy.column_stack([along, numpy.full_like(along, side * y), numpy.full_like(along, z)]))
                for at in (x, x + width):
                    across = numpy.arange(setback, setback + depth, 0.6)
                    points.append(numpy.column_stack([numpy.full_like(across, at), side * across, numpy.full_like(across, z)]))
            x += width + rng.uniform(1, 9)
    return numpy.concatenate(points)


def record(folder, walls, x0, x1, rng):
    """A drive from x0 to x1 in KITTI layout, in a frame of its own."""
    (folder / "velodyne").mkdir(parents=True)
    sign = 1 if x1 > x0 else -1
    rows = []
    for i, x in enumerate(numpy.arange(x0, x1, sign * STEP_M)):
        ground = numpy.stack(numpy.meshgrid(numpy.arange(x - RANGE_M, x + RANGE_M, 1.5), numpy.arange(-RANGE_M, RANGE_M, 1.5)), -1)
        ground = numpy.column_stack([ground.reshape(-1, 2), numpy.zeros(ground.size // 2)])
        seen = numpy.concatenate([walls[numpy.abs(walls[:, 0] - x) < RANGE_M], ground]) - [x, 0, 1.8]
        seen[:, :2] *= sign
        scan = numpy.zeros((len(seen), 4), numpy.float32)
        scan[:, :3] = seen + rng.normal(0, 0.02, seen.shape)
        scan.tofile(folder / "velodyne" / f"{i:06d}.bin")
        rows.append([1, 0, 0, i * STEP_M * (1 + 0.003 * sign), 0, 1, 0, 0, 0, 0, 1, 0])
    numpy.savetxt(folder / "poses.txt", rows)
    numpy.savetxt(folder / "times.txt", numpy.arange(len(rows)) * 0.2)


def write_street(folder):
    """Drives a, b (the other way round) and c in KITTI layout; each meets the next."""
    rng = numpy.random.default_rng(3)
    walls = town(rng)
    for name, x0, x1 in (("a", 0, 140), ("b", 230, 60), ("c", 110, 250)):
        record(folder / name, walls, x0, x1, rng)


def lasting_files(out):
    """What must not depend on how the run went: everything but the times in report and summary."""
    return {f.name: f.read_bytes() for f in sorted(out.iterdir())
            if f.suffix in (".tum", ".ply", ".pcd", ".g2o", ".txt") or f.name in ("overlaps.json", "groups.json")}
