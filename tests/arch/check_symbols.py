#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No allocation and no throw in the agent's archives: usage check_symbols.py ARCHIVE... (release build)."""
import re
import subprocess
import sys

import source_tree

FORBIDDEN = re.compile(
    r"^(malloc|calloc|realloc|free|posix_memalign|aligned_alloc|strdup|_Zn[wa]|_Zd[la]Pv|__cxa_throw|__cxa_allocate_exception|"
    r"_ZSt\d+__throw_|__cxa_guard_acquire|dlopen|pthread_create)")

problems, checked = [], 0
for archive in sys.argv[1:]:
    member = archive
    for line in subprocess.run(["nm", "-u", archive], check=True, capture_output=True, text=True).stdout.splitlines():
        if line.endswith(":"):
            member = line[:-1]
            checked += 1
        elif line.strip() and FORBIDDEN.match(line.split()[-1]):
            name = subprocess.run(["c++filt", line.split()[-1]], capture_output=True, text=True).stdout.strip()
            problems.append(f"{archive.split('/')[-1]} {member}: {name}")
source_tree.finish("symbols", problems, checked)
