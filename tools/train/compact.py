#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Shortens descriptors to their principal components: compact.py --learn TRAINING.csv ... --numbers 256 TABLE.csv ... -o FOLDER

Tables are those of mapweld describe. The mean and the directions come from the training tables only; FOLDER/TABLE.csv has
the first --numbers components as int8 in d0.., zeros after them, for mapweld eval places.
"""
import argparse
import pathlib

import numpy as np

FIXED, DESCRIPTOR = 5, 1024  # columns: scan, x, y, z, scale, then the descriptor


def read_table(path):
    return np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--learn", nargs="+", required=True)
    parser.add_argument("--numbers", type=int, default=256)
    parser.add_argument("tables", nargs="+", type=pathlib.Path)
    parser.add_argument("-o", "--out", type=pathlib.Path, required=True)
    a = parser.parse_args()
    known = np.concatenate([t[:, FIXED:FIXED + DESCRIPTOR] * t[:, 4:5] for t in map(read_table, a.learn)])
    mean = known.mean(0)
    directions = np.linalg.svd(known - mean, full_matrices=False)[2][:a.numbers]
    a.out.mkdir(parents=True, exist_ok=True)
    for path in a.tables:
        table = read_table(path)
        code = (table[:, FIXED:FIXED + DESCRIPTOR] * table[:, 4:5] - mean) @ directions.T
        scale = np.maximum(np.abs(code).max(1), 1e-9) / 127
        table[:, 4] = scale
        table[:, FIXED:] = 0
        table[:, FIXED:FIXED + code.shape[1]] = np.rint(code / scale[:, None])
        header = path.read_text().split("\n", 1)[0]
        np.savetxt(a.out / path.name, table, ["%d", "%.4f", "%.4f", "%.4f", "%.9g"] + ["%d"] * (table.shape[1] - FIXED),
                   ",", header=header, comments="")


if __name__ == "__main__":
    main()
