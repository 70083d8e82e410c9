#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws clouds that `mapweld sim --layout kitti` or `--layout gprs` wrote, as a PNG seen obliquely from above.

    tools/sim/picture.py -o scan.png out/vehicle_1/velodyne/000020.bin
    tools/sim/picture.py -o submap.png out/vehicle_1/000010.pcd
    tools/sim/picture.py -o world.png --poses out/vehicle_1/poses.txt out/vehicle_1/velodyne/*.bin

Colour is height above the ground near by, brightness is nearness to the ground's edge: blue low, white high.
"""
import argparse
import struct
import zlib

import numpy as np


def read_cloud(path):
    """An N x 3 array of a KITTI .bin or a binary .pcd whose first three fields are x y z floats."""
    data = open(path, "rb").read()
    if path.endswith(".bin"):
        return np.frombuffer(data, np.float32).reshape(-1, 4)[:, :3].astype(float)
    head, body = data.split(b"DATA binary\n", 1)
    fields = {line.split()[0]: line.split()[1:] for line in head.decode().splitlines() if line and line[0] != "#"}
    size = sum(int(s) * int(c) for s, c in zip(fields["SIZE"], fields["COUNT"]))
    n = int(fields["POINTS"][0])
    rows = np.frombuffer(body, np.uint8, n * size).reshape(n, size)
    return rows[:, :12].copy().view(np.float32).astype(float)


def read_poses(path):
    return np.loadtxt(path).reshape(-1, 3, 4)


def write_png(path, image):
    """`image`: height x width x 3 bytes."""
    height, width, _ = image.shape
    raw = b"".join(b"\0" + image[row].tobytes() for row in range(height))

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)))
        out.write(chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


STOPS = np.array([[0.0, 38, 50, 90], [0.1, 60, 90, 160], [0.3, 70, 170, 170], [0.55, 170, 205, 100],
                  [0.8, 245, 190, 80], [1.0, 250, 245, 235]])


def colours(height):
    t = np.clip(height / 10.0, 0, 1)
    return np.stack([np.interp(t, STOPS[:, 0], STOPS[:, c]) for c in (1, 2, 3)], axis=1)


def above_ground(points, cell=4.0):
    """Height over the lowest points of the neighbourhood."""
    keys = np.floor(points[:, :2] / cell).astype(np.int64)
    keys -= keys.min(axis=0)
    flat = keys[:, 0] * (keys[:, 1].max() + 1) + keys[:, 1]
    order = np.lexsort((points[:, 2], flat))
    firsts = np.flatnonzero(np.r_[True, np.diff(flat[order]) != 0])
    counts = np.diff(np.r_[firsts, len(order)])
    low = points[order[firsts + counts // 20], 2]  # the lowest twentieth: a stray return is no ground
    return points[:, 2] - np.repeat(low, counts)[np.argsort(order)]


def draw(points, width, height, tilt_deg, turn_deg, radius_m):
    """Orthographic, the middle of the picture over the points' median; nearer points cover farther ones."""
    over = above_ground(points)
    centre = np.median(points, axis=0)
    p = points - centre
    keep = np.hypot(p[:, 0], p[:, 1]) < radius_m
    p, over = p[keep], over[keep]
    turn, tilt = np.radians(turn_deg), np.radians(tilt_deg)
    right = p[:, 0] * np.cos(turn) + p[:, 1] * np.sin(turn)
    into = -p[:, 0] * np.sin(turn) + p[:, 1] * np.cos(turn)
    scale = width / (2 * radius_m)
    u = np.round(width / 2 + right * scale).astype(int)
    v = np.round(height / 2 - (into * np.sin(tilt) + p[:, 2] * np.cos(tilt)) * scale).astype(int)
    depth = into * np.cos(tilt) - p[:, 2] * np.sin(tilt)
    inside = (u >= 0) & (u < width) & (v >= 0) & (v < height)
    order = np.argsort(-depth[inside])
    image = np.full((height, width, 3), (14, 17, 26), np.uint8)
    image[v[inside][order], u[inside][order]] = colours(over[inside][order])
    return image


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("clouds", nargs="+")
    parser.add_argument("-o", "--out", required=True)
    parser.add_argument("--poses", help="poses.txt of the layout kitti, one row per cloud of the folder")
    parser.add_argument("--radius", type=float, default=60, help="metres from the middle to the left edge")
    parser.add_argument("--tilt", type=float, default=48, help="degrees: 90 looks straight down")
    parser.add_argument("--turn", type=float, default=20, help="degrees about the vertical")
    parser.add_argument("--size", default="1200x800")
    args = parser.parse_args()
    width, height = map(int, args.size.split("x"))
    if args.poses:
        poses = read_poses(args.poses)
        parts = []
        for path in sorted(args.clouds):
            pose = poses[int(path.rsplit("/", 1)[1].split(".")[0])]
            parts.append(read_cloud(path) @ pose[:, :3].T + pose[:, 3])
        points = np.concatenate(parts)
    else:
        points = np.concatenate([read_cloud(path) for path in args.clouds])
    write_png(args.out, draw(points, width, height, args.tilt, args.turn, args.radius))


if __name__ == "__main__":
    main()
