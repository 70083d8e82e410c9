# SPDX-License-Identifier: Apache-2.0
"""What the checks of this folder share: which files are ours, and how a check ends."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
CODE = {".hpp", ".cpp"}


def files(*folders, suffixes=CODE):
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in suffixes and path.is_file():
                yield path


def includes(path):
    """(line number, what is included, in angle brackets?)"""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        line = line.strip()
        if line.startswith("#include"):
            what = line[len("#include"):].strip()
            yield number, what[1:].split(">" if what[0] == "<" else '"')[0], what[0] == "<"


def finish(name, problems, checked):
    for problem in problems:
        print(problem)
    print(f"{name}: {checked} checked, {len(problems)} problems")
    sys.exit(1 if problems or checked == 0 else 0)
