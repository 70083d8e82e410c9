#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""All C++ files are as clang-format 14 writes them. Repair with: check_format.py --fix"""
import subprocess
import sys

import source_tree

paths = [str(p) for p in source_tree.files("core", "drivers", "firmware-like", "tools", "tests")]
if "--fix" in sys.argv:
    subprocess.run(["clang-format-14", "-i", *paths], check=True)
run = subprocess.run(["clang-format-14", "--dry-run", "-Werror", *paths], capture_output=True, text=True)
problems = sorted({line.split(":")[0].replace(str(source_tree.ROOT) + "/", "") for line in run.stderr.splitlines()
                   if "[-Wclang-format-violations]" in line})
source_tree.finish("format", [f"{p}: not formatted" for p in problems], len(paths))
