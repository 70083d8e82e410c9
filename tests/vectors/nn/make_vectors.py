#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes layers.mwm: inputs, parameters and results of every layer of core/nn by the rules in tools/train, in the format
of a model. --check compares with the file that is there and changes nothing."""
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "tools" / "train"))
import int8_rules as rules  # noqa: E402
from model_blob import encode_model, pack_weights  # noqa: E402

random = np.random.default_rng(20261125)
tensors = {}


def pad_rows(rows):
    """Channels to a multiple of 4."""
    return np.ascontiguousarray(np.pad(rows, [(0, 0)] * (rows.ndim - 1) + [(0, -rows.shape[-1] % 4)]))


def rows(*shape, lowest=-127):
    return random.integers(lowest, 128, shape).astype(np.int8)


def layer(name, inputs, outputs, out_range=100.0):
    """A layer whose outputs fill the range, its parameters stored under its name."""
    weights, _ = rules.quantize_weights(random.normal(size=(outputs, inputs)))
    bias = random.integers(-5000, 5000, outputs).astype(np.int32)
    spread = 73 * np.sqrt((weights.astype(float) ** 2).sum(axis=1))
    multiplier, shift = rules.fixed_point(out_range / 2 / spread)
    tensors[name + ".weight"] = pack_weights(weights)
    tensors[name + ".bias"] = rules.pad_outputs(bias)
    tensors[name + ".multiplier"] = rules.pad_outputs(multiplier, 2**30)
    tensors[name + ".shift"] = rules.pad_outputs(shift, 32)
    return weights, bias, multiplier, shift


for lowest, name in ((0, "relu"), (-127, "signed")):
    w, b, m, s = layer(name, 37, 21)
    x = rows(9, 37, lowest=lowest)
    sums = rules.linear_sums(x, w, b)
    tensors[name + ".x"] = pad_rows(x)
    tensors[name + ".sums"] = np.pad(sums, ((0, 0), (0, 3))).astype(np.int32)
    tensors[name + ".y"] = pad_rows(rules.requantize(sums, m, s, lowest))

w, b, m, s = layer("conv", 3 * 3 * 4, 8)
image = rows(7, 10, 4)
tensors["conv.x"] = image
tensors["conv.y"] = rules.conv2d(image, w, b, m, s, 0, 3)
tensors["conv.y_strided"] = rules.conv2d(image, w, b, m, s, 0, 3, 2, 2)

w, b, m, s = layer("vlad", 24, 10, out_range=1500.0)
x = rows(150, 24, lowest=0)
centres = random.uniform(0, 100, (10, 24)).astype(np.float32)
tensors["vlad.x"] = x
tensors["vlad.centres"] = centres
tensors["vlad.y"] = rules.net_vlad(x, w, b, m, s, centres, 1 / 512)

v = random.normal(0, 0.8, 32).astype(np.float32)
tensors["attention.x"] = v
tensors["attention.y"] = rules.self_attention(v, 0.7)

w, b, m, s = layer("gate", 16, 16)
x = rows(1, 16)
tensors["gate.x"] = x[0]
tensors["gate.y"] = rules.gate(x[0], rules.requantize(rules.linear_sums(x, w, b), m, s, -127)[0])

blob = encode_model("golden vectors of core/nn", tensors)
path = HERE / "layers.mwm"
if "--check" not in sys.argv[1:]:
    path.write_bytes(blob)
elif path.read_bytes() != blob:
    sys.exit(f"{path.name} is not what the rules in tools/train give; if they changed on purpose, run {sys.argv[0]}")
print(f"{path.name}: {len(tensors)} tensors, {len(blob)} bytes")
