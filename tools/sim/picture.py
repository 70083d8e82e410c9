#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws clouds that `mapweld sim --layout kitti` or `--layout gprs` wrote, as a PNG seen obliquely from above.

    tools/sim/picture.py -o scan.png out/vehicle_1/velodyne/000020.bin
    tools/sim/picture.py -o world.png out/vehicle_1                       # all scans of a drive, and its path
    tools/sim/picture.py -o sheet.png --sheet kitti/vehicle_1 gprs/vehicle_1    # the world, one scan, one submap

Colour is the height above the ground near by: blue low, yellow high. What lies deeper than its neighbours in the picture is
darker. Red: where the vehicle drove.
"""
import argparse
import pathlib

import numpy as np


def read_cloud(path):
    """An N x 3 array of a KITTI .bin or a binary .pcd whose first three fields are x y z floats."""
    data = pathlib.Path(path).read_bytes()
    if path.endswith(".bin"):
        return np.frombuffer(data, np.float32).reshape(-1, 4)[:, :3].astype(float)
    head, body = data.split(b"DATA binary\n", 1)
    fields = {line.split()[0]: line.split()[1:] for line in head.decode().splitlines() if line and line[0] != "#"}
    size = sum(int(s) * int(c) for s, c in zip(fields["SIZE"], fields["COUNT"]))
    n = int(fields["POINTS"][0])
    rows = np.frombuffer(body, np.uint8, n * size).reshape(n, size)
    return rows[:, :12].copy().view(np.float32).astype(float)


def read_poses(path):
    """An N x 3 x 4 array."""
    return np.loadtxt(path).reshape(-1, 3, 4)


def thinned(points, size):
    """One point per voxel."""
    _, first = np.unique(np.floor(points / size).astype(np.int64), axis=0, return_index=True)
    return points[first]


def read_drive(folder, size=0.12):
    """All scans of a drive in the frame of its first pose, one point per voxel, and the positions of the vehicle."""
    poses = read_poses(f"{folder}/poses.txt")
    parts = [thinned(read_cloud(f"{folder}/velodyne/{k:06}.bin") @ pose[:, :3].T + pose[:, 3], size)
             for k, pose in enumerate(poses)]
    return thinned(np.concatenate(parts), size), poses[:, :, 3]


STOPS = np.array([[0.0, 52, 74, 122], [0.08, 66, 104, 170], [0.25, 72, 168, 170], [0.5, 150, 200, 110],
                  [0.8, 245, 190, 80], [1.0, 250, 240, 215]])
BACKGROUND = (14, 17, 26)


def colours(height):
    """Of heights above the ground in metres: N x 3, 0 to 255."""
    t = np.clip(height / 9.0, 0, 1)
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
    over = np.empty(len(points))
    over[order] = points[order, 2] - np.repeat(low, counts)
    return over


def shade(depth, reach, strength):
    """0 to 1 per pixel: dark where the pixels `reach` away are nearer to the eye. `depth`: metres, infinite where nothing is."""
    inner = depth[reach:-reach, reach:-reach]
    nearer = np.zeros_like(inner)
    known = np.isfinite(inner)
    for du, dv in ((0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1)):
        beside = depth[reach + du * reach:depth.shape[0] - reach + du * reach,
                       reach + dv * reach:depth.shape[1] - reach + dv * reach]
        both = known & np.isfinite(beside)
        nearer[both] += np.clip(inner[both] - beside[both], 0, 2.0)
    out = np.ones_like(depth)
    out[reach:-reach, reach:-reach] = np.exp(-strength * nearer / 8)
    return out


def draw(points, size, radius_m, tilt_deg=48, turn_deg=20, centre=None, path=None, dot=1, finer=2):
    """Orthographic view as a height x width x 3 image of bytes.

    points: N x 3, metres. size: (width, height) in pixels. radius_m: from `centre` (default: the median) to the left edge.
    path: M x 3, drawn over all. dot: side of a point in pixels of the picture, which is drawn `finer` times larger first.
    """
    width, height = size[0] * finer, size[1] * finer
    centre = np.median(points, axis=0) if centre is None else centre
    turn, tilt = np.radians(turn_deg), np.radians(tilt_deg)
    scale = width / (2 * radius_m)

    def project(p):
        q = p - centre
        right = q[:, 0] * np.cos(turn) + q[:, 1] * np.sin(turn)
        into = -q[:, 0] * np.sin(turn) + q[:, 1] * np.cos(turn)
        u = np.floor(width / 2 + right * scale).astype(int)
        v = np.floor(height / 2 - (into * np.sin(tilt) + q[:, 2] * np.cos(tilt)) * scale).astype(int)
        return u, v, into * np.cos(tilt) - q[:, 2] * np.sin(tilt)

    u, v, depth = project(points)
    side = dot * finer
    order = np.argsort(-depth)
    u, v, depth = u[order], v[order], depth[order]
    image = np.empty((height, width, 3), np.float32)
    image[:] = BACKGROUND
    deep = np.full((height, width), np.inf, np.float32)
    colour = colours(above_ground(points))[order]
    # A dot of several pixels must not let a far one cover the corner of a near one: the nearest decides in each pixel.
    nearest = np.full(height * width, -1, np.int64)
    for du in range(side):
        for dv in range(side):
            inside = (u + du >= 0) & (u + du < width) & (v + dv >= 0) & (v + dv < height)
            index = np.flatnonzero(inside)  # rising index: falling depth, and the last one written stays
            pixel = (v[index] + dv) * width + u[index] + du
            layer = np.full(height * width, -1, np.int64)
            layer[pixel] = index
            nearest = np.maximum(nearest, layer)
    nearest = nearest.reshape(height, width)
    seen = nearest >= 0
    image[seen] = colour[nearest[seen]]
    deep[seen] = depth[nearest[seen]]
    image *= np.where(seen, shade(deep, finer, 2.5), 1)[:, :, None]
    if path is not None:
        steps = np.linspace(0, len(path) - 1, 40 * len(path))
        dense = np.stack([np.interp(steps, np.arange(len(path)), path[:, i]) for i in range(3)], axis=1)
        pu, pv, _ = project(dense)
        for du in range(-finer, finer + 1):
            for dv in range(-finer, finer + 1):
                inside = (pu + du >= 0) & (pu + du < width) & (pv + dv >= 0) & (pv + dv < height)
                image[pv[inside] + dv, pu[inside] + du] = (235, 70, 60)
    return image.reshape(size[1], finer, size[0], finer, 3).mean(axis=(1, 3)).astype(np.uint8)


def write_png(path, image, colours_kept=128):
    """`image`: height x width x 3 bytes. So many colours are plenty and make the file a third as large."""
    from PIL import Image
    Image.fromarray(image).quantize(colours_kept, Image.Quantize.FASTOCTREE, dither=0).save(path, optimize=True)


def sheet(drive, submaps, size, radius_m, turn_deg, scan=None):
    """The world as one drive saw it on the left; one scan and one submap on the right."""
    from PIL import Image, ImageDraw, ImageFont
    world, path = read_drive(drive)
    number = len(path) // 2 if scan is None else scan
    clouds = sorted(pathlib.Path(submaps).glob("*.pcd"))
    gap, right = 6, int(size[0] * 0.4)
    left, half = size[0] - right - gap, (size[1] - gap) // 2
    one = read_cloud(f"{drive}/velodyne/{number:06}.bin")
    submap = read_cloud(str(clouds[len(clouds) // 2]))
    near = radius_m * 0.55
    parts = [
        ((0, 0), "the drive",
         draw(world, (left, size[1]), radius_m, turn_deg=turn_deg, centre=path[number], path=path)),
        ((left + gap, 0), "one turn of the LiDAR",
         draw(one, (right, half), near, turn_deg=turn_deg, centre=np.zeros(3), dot=2)),
        ((left + gap, half + gap), "one submap", draw(submap, (right, half), near, turn_deg=turn_deg)),
    ]
    whole = Image.new("RGB", size, (235, 235, 235))
    pen = ImageDraw.Draw(whole)
    for at, caption, image in parts:
        whole.paste(Image.fromarray(image), at)
        pen.text((at[0] + 12, at[1] + 9), caption, fill=(225, 228, 235), font=ImageFont.truetype("DejaVuSans.ttf", 16))
    return np.asarray(whole)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("clouds", nargs="+", help="clouds or folders of drives; with --sheet: a drive, a folder of submaps")
    parser.add_argument("-o", "--out", required=True)
    parser.add_argument("--sheet", action="store_true", help="the world, one scan and one submap in one picture")
    parser.add_argument("--scan", type=int, help="with --sheet: which scan (default: the middle one)")
    parser.add_argument("--radius", type=float, default=60, help="metres from the middle to the left edge")
    parser.add_argument("--tilt", type=float, default=48, help="degrees: 90 looks straight down")
    parser.add_argument("--turn", type=float, default=20, help="degrees about the vertical")
    parser.add_argument("--size", default="960x576")
    args = parser.parse_args()
    size = tuple(map(int, args.size.split("x")))
    if args.sheet:
        image = sheet(*args.clouds, size, args.radius, args.turn, args.scan)
    else:
        read = [read_drive(c) if pathlib.Path(c).is_dir() else (read_cloud(c), None) for c in args.clouds]
        paths = [path for _, path in read if path is not None]
        image = draw(np.concatenate([points for points, _ in read]), size, args.radius, args.tilt, args.turn,
                     path=np.concatenate(paths) if paths else None)
    write_png(args.out, image)


if __name__ == "__main__":
    main()
