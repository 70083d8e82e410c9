#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Trains the place descriptor: train.py --sets A.npz[:train] ... --validation B.npz[:test] ... -o DIR

The loss compares every pair of views in a batch (InfoNCE over all views of one place, most negatives from the same
neighbourhood), for the weighted spectrum and for the network apart. Writes DIR/checkpoint.pt every 200 steps and goes on from there when it is started again; DIR/model.pt
at the end. Same seed, same machine, same weights.
"""
import argparse
import math
import pathlib
import time

import numpy as np
import torch

from network import TrainedCode, fuse
from places import draw_batch, open_places, recall


SHARE = 0.07  # of the network in what is reported as "both"


def describe(model, places, variant=0):
    """Spectrum [n, 1024] and network [n, 256] of all places."""
    model.eval()
    with torch.no_grad():
        parts = [model(torch.from_numpy(places.images(slice(i, i + 256), variant))) for i in range(0, len(places.drive), 256)]
    model.train()
    return [torch.cat(part) for part in zip(*parts)]


def loss_of(similarity, same, other):
    """-log of the share that a view of the same place has beside all views of other places; mean over the views."""
    others = torch.logsumexp(similarity.masked_fill(~other, -1e9), 1, keepdim=True)
    lost = torch.logaddexp(similarity, others.expand_as(similarity)) - similarity
    each = (lost * same).sum(1) / same.sum(1).clamp(min=1)
    return each[same.any(1)].mean()


def report(model, validation):
    """Recall@1 of spectrum, network and both; with disturbed views where the set has them."""
    words = []
    for places in validation:
        views = [describe(model, places, v) for v in range(min(3, places.image.shape[1]))]
        codes = [[spectrum, network, fuse(spectrum, network, SHARE)] for spectrum, network in views]
        clean = [recall(places, code.numpy(), code.numpy())[0] for code in codes[0]]
        words.append(f"{pathlib.Path(places.name).stem} " + " ".join(f"{r:.3f}" for r in clean))
        if len(views) == 3:
            disturbed = [recall(places, q.numpy(), d.numpy())[0] for q, d in zip(codes[1], codes[2])]
            words.append("(disturbed " + " ".join(f"{r:.3f}" for r in disturbed) + ")")
    return "Recall@1 of spectrum, network, both: " + ", ".join(words)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", nargs="+", required=True)
    parser.add_argument("--validation", nargs="+", required=True)
    parser.add_argument("-o", "--out", required=True)
    parser.add_argument("--steps", type=int, default=500)
    parser.add_argument("--neighbourhoods", type=int, default=8, help="of a batch")
    parser.add_argument("--places", type=int, default=8, help="of a neighbourhood, two views each")
    parser.add_argument("--rate", type=float, default=1.5e-3)
    parser.add_argument("--seed", type=int, default=0)
    a = parser.parse_args()
    torch.manual_seed(a.seed)
    rng = np.random.default_rng(a.seed)
    sets, validation = [open_places(s) for s in a.sets], [open_places(s) for s in a.validation]
    out = pathlib.Path(a.out)
    out.mkdir(parents=True, exist_ok=True)
    checkpoint = out / "checkpoint.pt"

    model = TrainedCode()
    # The spectrum's similarities lie close together, the network's do not.
    log_temperature = torch.nn.Parameter(torch.tensor([0.008, 0.07]).log())
    optimiser = torch.optim.AdamW([{"params": model.network.parameters(), "factor": 1, "weight_decay": 1e-2},
                                   {"params": model.spectrum.parameters(), "factor": 5, "weight_decay": 0},
                                   {"params": [log_temperature], "factor": 1, "weight_decay": 0}], lr=a.rate)
    first = 0
    if checkpoint.exists():
        saved = torch.load(checkpoint)
        model.load_state_dict(saved["model"])
        optimiser.load_state_dict(saved["optimiser"])
        log_temperature.data = saved["log_temperature"]
        torch.set_rng_state(saved["torch_rng"])
        rng.bit_generator.state = saved["rng"]
        first = saved["step"]
        print(f"goes on at step {first}")
    started, total = time.time(), 0.0
    for step in range(first + 1, a.steps + 1):
        rate = a.rate * min(1, step / 30) * (0.5 * (1 + math.cos(math.pi * step / a.steps)) + 0.01)
        for group in optimiser.param_groups:
            group["lr"] = rate * group["factor"]
        images, same, other = draw_batch(sets, rng, a.neighbourhoods, a.places)
        same, other = torch.from_numpy(same), torch.from_numpy(other)
        loss = sum(loss_of(z @ z.t() * torch.exp(-t), same, other)
                   for z, t in zip(model(torch.from_numpy(images)), log_temperature))
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        total += loss.item()
        if step % 200 == 0 or step == a.steps:
            print(f"step {step} of {a.steps}, loss {total / ((step - 1) % 200 + 1):.3f}, {time.time() - started:.0f} s; "
                  f"{report(model, validation)}", flush=True)
            total = 0.0
            torch.save({"model": model.state_dict(), "optimiser": optimiser.state_dict(), "step": step,
                        "log_temperature": log_temperature.data, "torch_rng": torch.get_rng_state(),
                        "rng": rng.bit_generator.state}, checkpoint)
    torch.save(model.state_dict(), out / "model.pt")


if __name__ == "__main__":
    main()
