#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The merge by several processes under MPI gives the bytes of one process, also when a rank is killed on the way.

    ranks.py MAPWELD MAPWELD_RANKS MPIRUN WORK_FOLDER"""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from street_recordings import lasting_files, write_street  # noqa: E402

MAPWELD, RANKS, MPIRUN, WORK = sys.argv[1], sys.argv[2], sys.argv[3], pathlib.Path(sys.argv[4])
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_mpi_yield_when_idle": "1"}


def check(condition, sentence):
    if not condition:
        sys.exit(f"ranks: {sentence}")


def start(ranks, out, *options):
    command = [MPIRUN, "--enable-recovery", "-n", str(ranks), RANKS, "merge", *(str(WORK / d) for d in "abc"), "-o",
               str(WORK / out), *options]
    return subprocess.Popen(command, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def process_of_rank(launcher, rank):
    """The process that is this rank of the launcher's, once it runs."""
    for _ in range(500):
        for folder in pathlib.Path("/proc").iterdir():
            try:
                mine = folder.name.isdigit() and f"\nPPid:\t{launcher.pid}\n" in (folder / "status").read_text()
                if mine and f"OMPI_COMM_WORLD_RANK={rank}".encode() in (folder / "environ").read_bytes().split(b"\0"):
                    return int(folder.name)
            except OSError:  # it has just ended
                pass
        time.sleep(0.01)
    sys.exit(f"ranks: rank {rank} did not start")


def mpi_works():
    """Can this machine start two processes under MPI at all? Some sandboxes cannot."""
    try:
        return subprocess.run([MPIRUN, "-n", "2", "true"], env=ENVIRONMENT, capture_output=True, timeout=60).returncode == 0
    except subprocess.TimeoutExpired:
        return False


if not mpi_works():
    print("SKIPPED: mpirun cannot start two processes on this machine, so mapweld-ranks was not tested")
    sys.exit(77)
shutil.rmtree(WORK, ignore_errors=True)
write_street(WORK)
subprocess.run([MAPWELD, "merge", *(str(WORK / d) for d in "abc"), "-o", str(WORK / "alone")], check=True, capture_output=True)
reference = lasting_files(WORK / "alone")
check(len(reference) >= 8, f"only {sorted(reference)} to compare")
for ranks in (1, 2, 4):
    process = start(ranks, f"by_{ranks}")
    said, _ = process.communicate(timeout=200)
    check(process.returncode == 0 and "3 drives in 1 group" in said, f"{ranks} ranks failed:\n{said}")
    check(lasting_files(WORK / f"by_{ranks}") == reference, f"{ranks} ranks give another map than one process")

for victim in (1, 2):
    out = f"without_{victim}"
    process = start(3, out)
    pid = process_of_rank(process, victim)
    for line in process.stdout:
        if "association" in line:  # now the pairs are handed out
            break
    os.kill(pid, signal.SIGKILL)
    said, _ = process.communicate(timeout=200)
    check("3 drives in 1 group" in said, f"without rank {victim}, which was killed, nothing went on:\n{said}")
    check(lasting_files(WORK / out) == reference, f"without rank {victim}, which was killed, the map is another one")

refused = subprocess.run([RANKS, "merge", "--store", str(WORK / "city.db"), "-o", str(WORK / "stored")], env=ENVIRONMENT,
                         capture_output=True, text=True)
check(refused.returncode != 0 and "without --store" in refused.stderr, f"a store was not refused: {refused.stderr}")
print(f"ranks: 1, 2 and 4 ranks, and 3 of which one is killed, give {len(reference)} identical files")
