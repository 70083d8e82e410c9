#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the longest files; more than 500 lines is more than one idea."""
import source_tree

LIMIT, TALK = 500, 300
lengths = sorted(((len(f.read_text().splitlines()), f.relative_to(source_tree.ROOT))
                  for f in source_tree.files("core", "drivers", "firmware-like", "tools", "tests")), reverse=True)
for length, path in lengths[:10]:
    print(f"{length:5} {path}" + ("   <- worth a talk" if length > TALK else ""))
median = lengths[len(lengths) // 2][0]
print(f"{len(lengths)} files, median {median} lines")
source_tree.finish("sizes", [f"{path}: {length} lines" for length, path in lengths if length > LIMIT], len(lengths))
