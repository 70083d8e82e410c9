#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""tools/sim/realism.py and picture.py on clouds small enough to count by hand."""
import importlib.util
import pathlib
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    print("skipped: this Python has no numpy")
    sys.exit(77)

sys.path.insert(0, str(pathlib.Path(__file__).parents[4] / "tools" / "sim"))
import picture  # noqa: E402
import realism  # noqa: E402


def has(module):
    return importlib.util.find_spec(module) is not None


def at(azimuth_deg, elevation_deg, distance_m):
    a, e = np.radians(azimuth_deg), np.radians(elevation_deg)
    return np.array([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)]).T * np.asarray(distance_m)[..., None]


def write_bin(path, points):
    np.c_[points, np.zeros(len(points))].astype(np.float32).tofile(path)


def write_drive(folder, scans, positions, times=None):
    """A vehicle that does not turn."""
    (folder / "velodyne").mkdir()
    for k, scan in enumerate(scans):
        write_bin(folder / "velodyne" / f"{k:06}.bin", scan)
    np.savetxt(folder / "poses.txt", [[1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z] for x, y, z in positions])
    np.savetxt(folder / "times.txt", np.arange(len(scans)) * 0.1 if times is None else times)


class Realism(unittest.TestCase):
    def test_the_road_is_the_most_frequent_height_near_by(self):
        near = np.c_[np.linspace(3, 14, 50), np.zeros(50), np.full(50, -1.73)]
        far = np.c_[np.linspace(20, 60, 500), np.zeros(500), np.full(500, -3.0)]
        self.assertAlmostEqual(realism.ground(np.r_[near, far]), -1.725)

    def test_voxels(self):
        points = np.array([[0.1, 0.1, 0.1], [0.4, 0.4, 0.4], [0.6, 0.1, 0.1], [-0.1, 0.1, 0.1], [51, 0, 0]])
        self.assertEqual(realism.voxels(points), 3)

    def test_planarity_is_the_spread_across_the_plane(self):
        x, y = (a.ravel() for a in np.meshgrid(np.linspace(0.1, 0.9, 4), np.linspace(0.1, 0.9, 4)))
        flat = np.c_[x, y, np.full(16, 0.5)]
        rough = flat + [5, 0, 0] + np.c_[np.zeros(16), np.zeros(16), np.array([1, -1, -1, 1] * 4) * 0.02]
        few = np.array([[9.5, 0.5, 0.5]] * 7)
        np.testing.assert_allclose(realism.planarity(np.r_[rough, few, flat]), [0, 0.02], atol=1e-6)

    def test_beams_by_the_order_of_the_file(self):
        beams = realism.BEAMS_DEG["vlp16"]
        azimuth = np.r_[0.5:180:1, -179.5:0:1]
        rings = [at(azimuth, np.full(360, 7.3), np.full(360, 9.0))[: 360 - k] for k in range(16)]
        counts = realism.per_beam(np.concatenate(rings), beams)
        self.assertEqual(counts.tolist(), [360 - k for k in range(16)])

    def test_beams_by_elevation(self):
        elevation = np.array([15.0, 14.8, 1.1, -14.2, -15.0])
        counts = realism.per_beam(at(np.zeros(5), elevation, np.full(5, 9.0)), realism.BEAMS_DEG["vlp16"])
        self.assertEqual({k: n for k, n in enumerate(counts) if n}, {0: 2, 7: 1, 15: 2})

    def test_noise_of_one_wrong_shot(self):
        r = np.full(11, 10.0)
        r[5] += 0.06
        beam_deg = -11.0
        scan = at(-0.2 * np.arange(11), np.full(11, beam_deg), r)
        noise = realism.shot_noise(scan, realism.BEAMS_DEG["vlp16"], road=10 * np.sin(np.radians(beam_deg)),
                                   least=8, most=15)
        np.testing.assert_allclose(noise * np.sqrt(6), [0, 0, 0, 0.06, 0.12, 0.06, 0, 0, 0], atol=1e-9)

    def test_a_turn_goes_clockwise(self):
        points = np.array([[1.0, -1e-9, 0], [0, -1, 0], [-1, 0, 0], [0, 1, 0]])
        np.testing.assert_allclose(realism.share_of_turn(points, 0), [0, 0.25, 0.5, 0.75], atol=1e-6)

    def test_what_a_moving_sensor_saw(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            ahead_and_behind = np.array([[10.0, 0, 0.35], [-10.0, 0, 0.35]])
            write_drive(folder, [ahead_and_behind] * 2, [(0, 0, 0), (2, 0, 0)], times=[0, 0.2])
            drive = realism.Drive(folder, np.array([0, 0, 0.35]))
            np.testing.assert_allclose(drive.scans[0], [[10, 0, 0], [-10, 0, 0]], atol=1e-6)
            # 1 m per turn; half a turn later it is half a metre further on.
            np.testing.assert_allclose(drive.seen[0], [[10, 0, 0], [-10.5, 0, 0]], atol=1e-6)

    def test_submaps_of_fifty_metres(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            positions = [(k, 0, 0) for k in range(100)]
            post = np.array([60.0, 8.25, 0.25])
            write_drive(folder, [np.array([post - p]) for p in positions], positions)
            clouds = realism.submaps(realism.Drive(folder))
            self.assertEqual([len(c) for c in clouds], [50, 50])
            self.assertEqual([realism.voxels(c) for c in clouds], [1, 1])
            np.testing.assert_allclose(clouds[0][0], post - [49, 0, 0], atol=1e-5)

    @unittest.skipUnless(has("scipy"), "no scipy")
    def test_residuals_are_what_noise_leaves(self):
        rng = np.random.default_rng(1)

        def corner(n):
            a, b = rng.uniform(-10, 10, n), rng.uniform(-10, 10, n)
            return np.concatenate([np.c_[a, b, np.full(n, -2.0)], np.c_[a, np.full(n, 12.0), b], np.c_[np.full(n, 14.0), a, b]])

        fixed, moved = corner(20000), corner(20000)
        r, t = realism.rotation(np.array([0, 0, 0.05])), np.array([0.4, -0.2, 0.1])
        moving = (moved - t) @ r
        exact, share = realism.residuals(fixed, moving, realism.rotation(np.array([0, 0, 0.04])), t + [0.15, 0, 0.05])
        self.assertLess(np.percentile(exact, 90), 1e-3)
        self.assertGreater(share, 0.9)
        off = moving + rng.choice([-0.05, 0.05], len(moving))[:, None] * np.ones(3)
        noisy, _ = realism.residuals(fixed, off, r, t)
        self.assertAlmostEqual(np.median(noisy), 0.05, delta=0.01)

    def test_how_far_histograms_are_apart(self):
        self.assertEqual(realism.apart(np.array([0.5, 0.5]), np.array([0.5, 0.5])), 0)
        self.assertEqual(realism.apart(np.array([1.0, 0]), np.array([0, 1.0])), 1)
        self.assertEqual(realism.apart(realism.share([1, 1, 2, 2], [0, 1.5, 3]), realism.share([1, 2, 2, 2], [0, 1.5, 3])), 0.25)


class Picture(unittest.TestCase):
    def test_clouds_with_more_fields_than_three(self):
        header = ("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity channel\nSIZE 4 4 4 1 2\nTYPE F F F U U\n"
                  "COUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA binary\n")
        rows = np.array([(1, 2, 3, 9, 7), (-4, 5, -6, 8, 6)], "<f4, <f4, <f4, u1, <u2")
        with tempfile.NamedTemporaryFile(suffix=".pcd") as file:
            file.write(header.encode() + rows.tobytes())
            file.flush()
            self.assertEqual(picture.read_cloud(file.name).tolist(), [[1, 2, 3], [-4, 5, -6]])

    def test_height_over_the_ground_near_by(self):
        low = [[x, 1.0, 2.0] for x in np.linspace(0.1, 3.9, 30)]
        points = np.array(low + [[2.0, 1.0, 5.0], [9.0, 1.0, 7.0]])
        self.assertEqual(picture.above_ground(points)[-2:].tolist(), [3, 0])

    def test_the_nearer_point_hides_the_farther_one(self):
        # From straight above, 1 m per pixel: a high point over a low one, and one 2 m to the right.
        points = np.array([[0.0, 0, 0], [0.0, 0, 8.0], [2.0, 0, 0]])
        image = picture.draw(points, (9, 7), 4.5, tilt_deg=90, turn_deg=0, centre=np.zeros(3), finer=1)
        lit = [tuple(int(i) for i in at) for at in np.argwhere((image != picture.BACKGROUND).any(axis=2))]
        row, column = 3, 4
        self.assertEqual(lit, [(row, column), (row, column + 2)])
        np.testing.assert_allclose(image[row, column], picture.colours(np.array([8.0]))[0], atol=1)

    def test_edges_are_darker_behind_what_is_nearer(self):
        depth = np.full((7, 7), 10.0)
        depth[:, :3] = 9.0
        shaded = picture.shade(depth, 1, 2.5)
        self.assertEqual(shaded[3, 2], 1)
        self.assertAlmostEqual(shaded[3, 3], np.exp(-2.5 * 3 / 8))
        self.assertEqual(shaded[3, 4], 1)


if __name__ == "__main__":
    unittest.main()
