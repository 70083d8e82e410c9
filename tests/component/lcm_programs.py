#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Our LCM transport and the programs of liblcm hear every message of each other, in a network of their own.

usage: lcm_programs.py OUR_TRANSPORT WORK_DIR [MESSAGES]. Ours sends at 1 kHz to lcm-logger and to a receiver of its own
kind; lcm-logplayer plays that log back to ours. Exit code 77: skipped, with the reason.
"""
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import time

URL = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=200000"

ours, work = sys.argv[1], pathlib.Path(sys.argv[2])
messages = sys.argv[3] if len(sys.argv) > 3 else "10000"
if os.environ.get("MAPWELD_OWN_NETWORK") is None:
    for needed in ("lcm-logger", "lcm-logplayer", "unshare", "ip"):
        if shutil.which(needed) is None:
            print(f"SKIPPED: {needed} is not installed")
            sys.exit(77)
    unshare = ["unshare", "--net"] + ([] if os.geteuid() == 0 else ["--map-root-user"])
    if subprocess.run(unshare + ["true"]).returncode != 0:
        print("SKIPPED: not allowed to make a network namespace")
        sys.exit(77)
    os.execvpe(unshare[0], unshare + [sys.executable] + sys.argv, os.environ | {"MAPWELD_OWN_NETWORK": "1"})

subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
subprocess.run(["ip", "route", "add", "224.0.0.0/4", "dev", "lo"], check=True)
work.mkdir(parents=True, exist_ok=True)
log = work / "bench.lcmlog"


def start(mode):
    process = subprocess.Popen([ours, mode, URL, messages], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    return process


def end(process):
    """(failed, lost): see our_transport.cpp for the exit codes."""
    print(process.communicate()[0].strip())
    return process.returncode not in (0, 3), process.returncode == 3


def logged():
    """(channel, payload) of every event in the log: sync word, number, time, lengths, all big-endian."""
    data, at = log.read_bytes(), 0
    while at + 28 <= len(data):
        sync, _, _, channel, payload = struct.unpack_from(">IqqII", data, at)
        assert sync == 0xEDA1DA01, "not an LCM log"
        at += 28
        yield data[at:at + channel], data[at + channel:at + channel + payload]
        at += channel + payload


# The sockets' buffers are small: on a busy machine messages that were sent get lost, and then we try again.
for attempt in range(3):
    log.unlink(missing_ok=True)
    logger = subprocess.Popen(["lcm-logger", "-f", f"--lcm-url={URL}", log], stdout=subprocess.DEVNULL)
    time.sleep(1)
    receiver, sender = start("receive"), start("send")
    results = [end(sender), end(receiver)]
    time.sleep(1)
    logger.terminate()
    logger.wait()
    numbers = [int.from_bytes(payload[:4], "big") for channel, payload in logged() if channel == b"BENCH"]
    in_order = all(x < y for x, y in zip(numbers, numbers[1:]))
    print(f"lcm-logger heard {len(numbers)} of {messages}, in order: {in_order}")
    results.append((not in_order, len(numbers) != int(messages)))

    if not results[-1][1]:
        receiver = start("receive")
        subprocess.run(["lcm-logplayer", f"--lcm-url={URL}", log], check=True, stdout=subprocess.DEVNULL)
        print("played by lcm-logplayer: ", end="", flush=True)
        results.append(end(receiver))
    if any(failed for failed, _ in results):
        sys.exit(1)
    if not any(lost for _, lost in results):
        sys.exit(0)
print("SKIPPED: this machine is too busy: messages that were sent got lost in the sockets' buffers")
sys.exit(77)
