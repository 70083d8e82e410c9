#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Trains the place descriptor: train.py --sets A.npz[:train] ... --validation B.npz[:test] ... -o DIR

The loss compares every pair of views in a batch (InfoNCE over all views of one place, most negatives from the same
neighbourhood), for the weighted spectrum and for the network apart. DIR/model.pt is the best so far by the mean Recall@1
of the validation sets that --choose-by names, with disturbed views. DIR/checkpoint.pt is where it goes on when it is
started again. Same seed, same machine, same weights, unless --minutes ends it sooner.
"""
import argparse
import math
import pathlib
import time

import numpy as np
import torch

from network import CHANNELS, NETWORK_OUTPUTS, SHARE, TrainedCode, fuse
from places import draw_batch, open_places, recall


def describe(model, places, variant, device):
    """Spectrum [n, 1024] and network [n, outputs] of all places, on the CPU."""
    model.eval()
    with torch.no_grad():
        parts = [model(torch.from_numpy(places.images(slice(i, i + 256), variant)).to(device))
                 for i in range(0, len(places.drive), 256)]
    model.train()
    return [torch.cat(part).cpu() for part in zip(*parts)]


def loss_of(similarity, same, other):
    """-log of the share that a view of the same place has beside all views of other places; mean over the views."""
    others = torch.logsumexp(similarity.masked_fill(~other, -1e9), 1, keepdim=True)
    lost = torch.logaddexp(similarity, others.expand_as(similarity)) - similarity
    each = (lost * same).sum(1) / same.sum(1).clamp(min=1)
    return each[same.any(1)].mean()


def report(model, places, share, device):
    """Recall@1 of spectrum, network and both: [as recorded, one disturbed view against another]."""
    views = [describe(model, places, v, device) for v in range(min(3, places.image.shape[1]))]
    codes = [[code.numpy() for code in (spectrum, network, fuse(spectrum, network, share))] for spectrum, network in views]
    pairs = [(codes[0], codes[0])] + ([(codes[1], codes[2])] if len(codes) == 3 else [])
    return [[recall(places, q, d)[0] for q, d in zip(*pair)] for pair in pairs]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", nargs="+", required=True)
    parser.add_argument("--validation", nargs="+", required=True)
    parser.add_argument("--choose-by", default="", help="only validation sets with this in their name choose the weights")
    parser.add_argument("-o", "--out", required=True)
    parser.add_argument("--steps", type=int, default=3000)
    parser.add_argument("--minutes", type=float, default=1e9, help="end after so long; the learning rate follows")
    parser.add_argument("--neighbourhoods", type=int, default=16, help="of a batch")
    parser.add_argument("--places", type=int, default=8, help="of a neighbourhood, two views each")
    parser.add_argument("--channels", type=int, nargs=3, default=CHANNELS)
    parser.add_argument("--outputs", type=int, default=NETWORK_OUTPUTS)
    parser.add_argument("--share", type=float, default=SHARE, help="of the network in what is reported as both")
    parser.add_argument("--rate", type=float, default=1.5e-3)
    parser.add_argument("--every", type=int, default=200, help="steps between validations")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--device", default="cpu")
    a = parser.parse_args()
    torch.manual_seed(a.seed)
    rng = np.random.default_rng(a.seed)
    sets, validation = [open_places(s) for s in a.sets], [open_places(s) for s in a.validation]
    out = pathlib.Path(a.out)
    out.mkdir(parents=True, exist_ok=True)
    checkpoint = out / "checkpoint.pt"

    model = TrainedCode(a.channels, a.outputs).to(a.device)
    # The spectrum's similarities lie close together, the network's do not.
    log_temperature = torch.nn.Parameter(torch.tensor([0.008, 0.07], device=a.device).log())
    optimiser = torch.optim.AdamW([{"params": model.network.parameters(), "factor": 1, "weight_decay": 1e-2},
                                   {"params": model.spectrum.parameters(), "factor": 5, "weight_decay": 0},
                                   {"params": [log_temperature], "factor": 1, "weight_decay": 0}], lr=a.rate)
    first, best = 0, -1.0
    if checkpoint.exists():
        saved = torch.load(checkpoint, map_location=a.device, weights_only=False)
        model.load_state_dict(saved["model"])
        optimiser.load_state_dict(saved["optimiser"])
        log_temperature.data = saved["log_temperature"]
        torch.set_rng_state(saved["torch_rng"].cpu())
        rng.bit_generator.state = saved["rng"]
        first, best = saved["step"], saved["best"]
        print(f"goes on at step {first}")
    started, total = time.time(), 0.0
    for step in range(first + 1, a.steps + 1):
        done = max(step / a.steps, (time.time() - started) / 60 / a.minutes)
        rate = a.rate * min(1, step / 30) * (0.5 * (1 + math.cos(math.pi * min(done, 1))) + 0.01)
        for group in optimiser.param_groups:
            group["lr"] = rate * group["factor"]
        views, same, other = draw_batch(sets, rng, a.neighbourhoods, a.places)
        images = torch.from_numpy(np.stack([s.images(i, v) for s, i, v in views])).to(a.device)
        same, other = torch.from_numpy(same).to(a.device), torch.from_numpy(other).to(a.device)
        loss = sum(loss_of(z @ z.t() * torch.exp(-t), same, other) for z, t in zip(model(images), log_temperature))
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        total += loss.item()
        if step % a.every == 0 or step == a.steps or done >= 1:
            scores = {places.name: report(model, places, a.share, a.device) for places in validation}
            mean = float(np.mean([s[-1][2] for name, s in scores.items() if a.choose_by in name]))
            words = [f"{pathlib.Path(name).stem} " + " ".join("/".join(f"{r:.3f}" for r in pair) for pair in zip(*s))
                     for name, s in scores.items()]
            print(f"step {step} of {a.steps}, loss {total / ((step - 1) % a.every + 1):.3f}, {time.time() - started:.0f} s; "
                  f"{mean:.4f}; Recall@1 of spectrum, network, both, as recorded/disturbed: " + ", ".join(words), flush=True)
            total = 0.0
            if mean > best:
                best = mean
                model.save(out / "model.pt")
            torch.save({"model": model.state_dict(), "optimiser": optimiser.state_dict(), "step": step, "best": best,
                        "log_temperature": log_temperature.data, "torch_rng": torch.get_rng_state(),
                        "rng": rng.bit_generator.state}, checkpoint)
        if done >= 1:
            break


if __name__ == "__main__":
    main()
