#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Simulated VLP-16 packets mean the same to our driver and to a decoder that others wrote.

usage: independent_decoder.py MAPWELD DECODE_VELODYNE WORK_DIR. The other decoder is the npm package
@foxglove/velodyne-cloud, fetched into WORK_DIR. It gives every laser of a block the block's azimuth, so our points are
turned back by what the sensor turned since the block began. Exit code 77: skipped, with the reason.
"""
import math
import os
import pathlib
import shutil
import struct
import subprocess
import sys

mapweld, decode, work = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
here = pathlib.Path(__file__).parent
if shutil.which("node") is None or shutil.which("npm") is None:
    print("SKIPPED: node and npm are not installed")
    sys.exit(77)
work.mkdir(parents=True, exist_ok=True)
if not (work / "node_modules/@foxglove/velodyne-cloud").exists():
    install = ["npm", "install", "--prefix", str(work), "--no-audit", "--no-fund", "@foxglove/velodyne-cloud@1.0.1"]
    if subprocess.run(install, capture_output=True).returncode != 0:
        print("SKIPPED: npm cannot fetch @foxglove/velodyne-cloud")
        sys.exit(77)

subprocess.run([mapweld, "sim", "-o", str(work / "sim"), "--vehicles", "1", "--seconds", "1"], check=True,
               capture_output=True)
capture = work / "sim/vehicle_1/lidar.pcap"
ours = subprocess.run([decode, str(capture)], check=True, capture_output=True, text=True).stdout.splitlines()
theirs = subprocess.run(["node", str(here / "independent_decoder.js"), str(capture)], check=True, capture_output=True,
                        text=True, env=os.environ | {"NODE_PATH": str(work / "node_modules")}).stdout.splitlines()
assert len(ours) == len(theirs) > 10000, (len(ours), len(theirs))

BLOCK_NS = 110592
blob = capture.read_bytes()
azimuths = []  # of the twelve blocks of every packet, 0.01 degrees
for at in range(24 + 58, len(blob), 58 + 1206):
    azimuths.append([struct.unpack_from("<H", blob, at + 100 * block + 2)[0] for block in range(12)])

worst = 0.0
for our_line, their_line in zip(ours, theirs):
    packet, x, y, z, dt_ns = our_line.split()
    their_packet, *their_xyz = their_line.split()
    assert packet == their_packet
    x, y, z = float(x), float(y), float(z)
    block, since_ns = divmod(int(dt_ns), BLOCK_NS)
    row = azimuths[int(packet)]
    step = (row[min(block + 1, 11)] - row[min(block, 10)]) % 36000
    turned = math.radians(step * 0.01 * since_ns / BLOCK_NS)  # clockwise
    c, s = math.cos(turned), math.sin(turned)
    back = (x * c - y * s, x * s + y * c, z)
    worst = max(worst, math.dist(back, [float(v) for v in their_xyz]))
print(f"{len(ours)} points, worst difference {1000 * worst:.2f} mm")
assert worst < 0.002
