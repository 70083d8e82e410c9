# SPDX-License-Identifier: Apache-2.0
"""Submaps with true poses, as train_submaps (submap_set.cpp) writes them."""
import struct
from dataclasses import dataclass

import numpy as np

MAGIC = b"MWSUBMAP"


@dataclass
class Submap:
    drive: int
    world_T_level: np.ndarray  # [3, 4], metres
    points: np.ndarray         # [n, 3] float32, metres, level frame


def read_submaps(path):
    """Yields the submaps of a file in its order; ValueError when it is no such file or ends early."""
    with open(path, "rb") as file:
        if file.read(len(MAGIC)) != MAGIC:
            raise ValueError(f"{path}: not a submap set; train_submaps writes them")
        while head := file.read(8):
            if len(head) < 8:
                raise ValueError(f"{path}: ends within a submap")
            drive, n = struct.unpack("<ii", head)
            pose = file.read(96)
            points = file.read(6 * n)
            if len(pose) < 96 or len(points) < 6 * n:
                raise ValueError(f"{path}: ends within a submap")
            yield Submap(drive, np.frombuffer(pose, "<f8").reshape(3, 4),
                         np.frombuffer(points, "<i2").reshape(n, 3).astype(np.float32) * np.float32(0.01))
