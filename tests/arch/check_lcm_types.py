#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Messages have fixed-size fields only, one type per file, and a comment with unit or meaning on every field."""
import re

import source_tree

PRIMITIVE = {"int8_t", "int16_t", "int32_t", "int64_t", "float", "double", "byte", "boolean"}
FIELD = re.compile(r"^\s*(\w+)\s+(\w+)((?:\[[^\]]+\])*)\s*;(.*)$")

problems, checked = [], 0
for file in source_tree.files("lcmtypes", suffixes={".lcm"}):
    text = file.read_text()
    structs = re.findall(r"struct\s+(\w+)", text)
    if structs != [file.stem]:
        problems.append(f"{file.name}: must hold exactly the struct {file.stem}")
    for number, line in enumerate(text.splitlines(), 1):
        field = FIELD.match(line)
        if not field or field.group(1) in {"package", "const"}:
            continue
        checked += 1
        kind, name, dims, rest = field.groups()
        if kind not in PRIMITIVE:
            problems.append(f"{file.name}:{number}: {name} is a {kind}: only numbers have a fixed size")
        if re.search(r"\[[^\]]*[A-Za-z_][^\]]*\]", dims):
            problems.append(f"{file.name}:{number}: {name} has a variable length")
        if "//" not in rest and name not in {"agent_id", "epoch", "keyframe", "descriptor", "orientation", "data"} \
                and not name.endswith("_q_body"):
            problems.append(f"{file.name}:{number}: {name} says neither unit nor meaning")
source_tree.finish("lcm types", problems, checked)
