#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every source file names its licence in its first lines."""
import source_tree

SUFFIXES = {".hpp", ".cpp", ".py", ".cmake", ".txt"}
problems, checked = [], 0
for file in source_tree.files("core", "drivers", "firmware-like", "lcmtypes", "tools", "tests", "toolchain", suffixes=SUFFIXES):
    if file.suffix == ".txt" and file.name not in {"CMakeLists.txt", "allowed_headers.txt"}:
        continue
    checked += 1
    if "SPDX-License-Identifier: Apache-2.0" not in "".join(file.read_text().splitlines(True)[:3]):
        problems.append(f"{file.relative_to(source_tree.ROOT)}: no SPDX line")
source_tree.finish("spdx", problems, checked)
