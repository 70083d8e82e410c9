#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`mapweld merge --store` as a user runs it: a drive is added tomorrow, the program is killed and interrupted at random
moments; the map is always that of one undisturbed merge of everything, byte for byte.

    store_resumes.py MAPWELD WORK_FOLDER        MAPWELD_KILLS=100 for a night"""
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from street_recordings import lasting_files, write_street  # noqa: E402

MAPWELD, WORK = sys.argv[1], pathlib.Path(sys.argv[2])
KILLS = int(os.environ.get("MAPWELD_KILLS", "6"))


def merge(out, drives, *options):
    return [MAPWELD, "merge", *(str(WORK / d) for d in drives), "-o", str(WORK / out), "--threads", "2", *options]


def run(command, **options):
    return subprocess.run(command, capture_output=True, text=True, **options)


def check(condition, sentence):
    if not condition:
        sys.exit(f"store_resumes: {sentence}")


shutil.rmtree(WORK, ignore_errors=True)
write_street(WORK)
at_once = run(merge("at_once", "abc"), check=True)
reference = lasting_files(WORK / "at_once")
check("3 drives in 1 group" in at_once.stdout, f"the street is not one group, so the test says little:\n{at_once.stdout}")
check(len(reference) >= 8, f"only {sorted(reference)} to compare")

# Tomorrow a drive is added.
store = str(WORK / "city.db")
run(merge("today", "ab", "--store", store), check=True)
tomorrow = run(merge("tomorrow", "c", "--store", store), check=True)
check(lasting_files(WORK / "tomorrow") == reference, "a drive added tomorrow gives another map than all at once")
check("a: submaps" not in tomorrow.stderr, "a was built again")
check("2 pairs of them searched now, 1 before" in tomorrow.stderr, f"not only what is new was searched: {tomorrow.stderr}")
again = run(merge("again", "", "--store", store), check=True)
check(lasting_files(WORK / "again") == reference, "what the store holds was not merged as it was")
check("0 pairs of them searched now" in again.stderr, f"something was searched again: {again.stderr}")

# Decisions by hand.
history = run([MAPWELD, "history", store], check=True).stdout
check("a + b joined" in history and "a + b + c joined" in history, f"history does not tell what joined:\n{history}")
explained = run([MAPWELD, "explain", store, "a", "b"], check=True).stdout
check("overlap accepted" in explained, explained)
run([MAPWELD, "undo", store], check=True)
undone = run(merge("undone", "", "--store", store), check=True)
check("3 drives in 2 groups" in undone.stdout, f"undo did not last:\n{undone.stdout}")
run([MAPWELD, "quarantine", store, "c"], check=True)
check("2 drives in 1 group" in run(merge("without_c", "", "--store", store), check=True).stdout, "c was not left out")
refused = run([MAPWELD, "quarantine", store, "nobody"])
check(refused.returncode == 1 and "it holds a, b, c" in refused.stderr, refused.stderr)
check(run([MAPWELD, "fsck", store]).returncode == 0, "fsck finds fault with a sound store")

# Killed and interrupted at random moments, then to the end.
random.seed(1)
store = str(WORK / "killed.db")
for i in range(KILLS):
    process = subprocess.Popen(merge("killed", "abc", "--store", store), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    how = random.choice((signal.SIGKILL, signal.SIGINT, signal.SIGTERM))
    try:
        _, error = process.communicate(timeout=random.uniform(0.05, 4.0))
        check(process.returncode == 0, f"ended by itself: {error}")
    except subprocess.TimeoutExpired:
        process.send_signal(how)
        _, error = process.communicate()
        if process.returncode not in (0, -how):  # done in that moment, or killed before it could do anything
            check(process.returncode == 128 + how and "goes on where this one was" in error,
                  f"{how.name}: exit code {process.returncode}, {error[-300:]}")
        if how != signal.SIGKILL:
            left = list((WORK / "killed").glob("*.partial*")) if (WORK / "killed").exists() else []
            check(not left, f"half-written files stay: {left}")
    if os.path.exists(store):
        fsck = run([MAPWELD, "fsck", store])
        check(fsck.returncode == 0 or "is empty" in fsck.stderr, f"after kill {i}: {fsck.stdout}{fsck.stderr}")
run(merge("killed", "abc", "--store", store), check=True)
check(lasting_files(WORK / "killed") == reference, "after the kills the map is another one")
print(f"store_resumes: {KILLS} kills, {len(reference)} files identical to an undisturbed merge")
