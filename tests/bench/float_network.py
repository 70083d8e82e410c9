#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the trained descriptor costs in floating point, by PyTorch on one thread: from the plan image to the code, as the row
"trained, from the image on" of describe_bench. The weights are random: they cost the same."""
import os
import pathlib
import sys
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")
import torch  # noqa: E402

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools/train"))
from network import TrainedCode  # noqa: E402


def main():
    torch.set_num_threads(1)
    model, image = TrainedCode().eval(), torch.rand(1, 3, 32, 64)
    ms = []
    with torch.no_grad():
        for _ in range(200):
            begun = time.thread_time()
            model(image)
            ms.append(1e3 * (time.thread_time() - begun))
    ms = sorted(ms[20:])
    print(f"float, PyTorch {torch.__version__}: {ms[len(ms) // 2]:.2f} ms p50  {ms[len(ms) * 99 // 100]:.2f} ms p99")


if __name__ == "__main__":
    main()
