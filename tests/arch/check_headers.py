#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The agent uses only headers that cannot bring the heap, exceptions or the locale with them (allowed_headers.txt)."""
import pathlib

import source_tree

rules = {}
section = None
for line in (pathlib.Path(__file__).parent / "allowed_headers.txt").read_text().splitlines():
    line = line.split("#")[0].strip()
    if line.startswith("["):
        section = line.strip("[]")
        rules[section] = set()
    elif line:
        rules[section].update(line.split())

problems, checked = [], 0
for layer in ("core", "drivers", "firmware-like"):
    allowed = set(rules["core"]) if layer == "core" else rules["core"] | rules["drivers"]
    if layer == "firmware-like":
        allowed |= rules["firmware-like"]
    for file in source_tree.files(layer):
        for line, header, system in source_tree.includes(file):
            if not system or header.startswith("mapweldlcm/"):
                continue
            checked += 1
            if header not in allowed:
                problems.append(f"{file.relative_to(source_tree.ROOT)}:{line}: <{header}> is not allowed in {layer}")
source_tree.finish("headers", problems, checked)
