# SPDX-License-Identifier: Apache-2.0
"""Writes and reads the model blob that core/nn/model_blob.hpp opens. The layout is in docs/model_format.md.

    write_model("place.mwm", "place-1 2026-11-25", {"fc.weight": pack_weights(w), "fc.bias": b, ...})
"""
import struct
import zlib

import numpy as np

MAGIC = b"MWMODEL\0"
VERSION = 1
ALIGNMENT = 64
HEADER_BYTES = 128
ENTRY_BYTES = 64
NAME_BYTES = 32
MODEL_NAME_BYTES = 64
MAX_TENSORS = 1024
CHECKED_FROM = 20  # the checksum covers everything from here
TYPES = {1: np.dtype("<i1"), 2: np.dtype("<i4"), 3: np.dtype("<f4")}


def _aligned(n):
    return (n + ALIGNMENT - 1) // ALIGNMENT * ALIGNMENT


def _padded(text, size):
    raw = text.encode("ascii")
    if not raw or b"\0" in raw or len(raw) >= size:
        raise ValueError(f"a name needs 1 to {size - 1} characters: {text!r}")
    return raw.ljust(size, b"\0")


def pack_weights(weights):
    """[N][K] in -127..127 -> int8 [ceil(N/8)][ceil(K/4)][8][4], zero padded: 8 outputs x 4 inputs lie side by side."""
    w = np.asarray(weights)
    if w.ndim != 2 or np.abs(w.astype(np.int64)).max(initial=0) > 127:
        raise ValueError("weights are a matrix of integers in -127..127")
    n, k = w.shape
    padded = np.zeros((-(-n // 8) * 8, -(-k // 4) * 4), np.int8)
    padded[:n, :k] = w
    return np.ascontiguousarray(padded.reshape(-1, 8, padded.shape[1] // 4, 4).transpose(0, 2, 1, 3))


def unpack_weights(packed, n, k):
    """The inverse of pack_weights."""
    return packed.transpose(0, 2, 1, 3).reshape(packed.shape[0] * 8, -1)[:n, :k]


def encode_model(name, tensors):
    """name: what the model is, for logs. tensors: {name: array of int8, int32 or float32, 1 to 4 dimensions}."""
    if len(tensors) > MAX_TENSORS:
        raise ValueError(f"at most {MAX_TENSORS} tensors")
    offset = _aligned(HEADER_BYTES + ENTRY_BYTES * len(tensors))
    directory, data = b"", b""
    for tensor_name, array in tensors.items():
        array = np.asarray(array)
        code = next((c for c, t in TYPES.items() if t == array.dtype), None)
        if code is None or not 1 <= array.ndim <= 4 or array.size == 0:
            raise ValueError(f"{tensor_name}: int8, int32 or float32 with 1 to 4 dimensions, not {array.dtype} {array.shape}")
        raw = array.astype(TYPES[code]).tobytes(order="C")
        shape = list(array.shape) + [0] * (4 - array.ndim)
        directory += _padded(tensor_name, NAME_BYTES) + struct.pack("<8I", code, *shape, offset + len(data), len(raw), 0)
        data += raw.ljust(_aligned(len(raw)), b"\0")
    directory = directory.ljust(offset - HEADER_BYTES, b"\0")
    checked = struct.pack("<IQ", len(tensors), 0) + _padded(name, MODEL_NAME_BYTES) + bytes(32) + directory + data
    head = MAGIC + struct.pack("<III", VERSION, CHECKED_FROM + len(checked), zlib.crc32(checked))
    return head + checked


def write_model(path, name, tensors):
    with open(path, "wb") as file:
        file.write(encode_model(name, tensors))


def read_model(path):
    """(name, {tensor name: array}); ValueError when the file is not one that write_model wrote."""
    with open(path, "rb") as file:
        blob = file.read()
    if len(blob) < HEADER_BYTES or blob[:8] != MAGIC:
        raise ValueError(f"{path}: not a model")
    version, size, checksum, count = struct.unpack_from("<4I", blob, 8)
    if version != VERSION:
        raise ValueError(f"{path}: format version {version}, this program reads {VERSION}")
    if size != len(blob) or checksum != zlib.crc32(blob[CHECKED_FROM:]):
        raise ValueError(f"{path}: damaged (size or checksum)")
    tensors = {}
    for i in range(count):
        at = HEADER_BYTES + i * ENTRY_BYTES
        code, *shape, offset, nbytes, _ = struct.unpack_from("<8I", blob, at + NAME_BYTES)
        array = np.frombuffer(blob, TYPES[code], nbytes // TYPES[code].itemsize, offset)
        tensors[blob[at:at + NAME_BYTES].rstrip(b"\0").decode()] = array.reshape([d for d in shape if d])
    return blob[32:32 + MODEL_NAME_BYTES].rstrip(b"\0").decode(), tensors
