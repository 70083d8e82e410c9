#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The networks of AutoMerge (Yin et al., T-RO 2023) in floating point, for comparison with the trained descriptor:

    paper.py --branch point|sphere|fused --sets A.npz ... --validation B.npz ... -o DIR    trains; DIR/BRANCH.pt
    paper.py --describe SET.npz OUT MODEL.pt [MODEL.pt]    OUT.DRIVE.csv, tables for mapweld eval places; two models side by side

Sets are those of inputs.py --points. Point branch: PointNet on 4096 points of 80 x 80 m, NetVLAD, fully connected, 512
numbers. Sphere branch: four zonal spherical convolutions on a 64 x 64 panorama, NetVLAD, fully connected, 512 numbers.
Fused: both side by side, self attention (eq. 1) on each, cross attention (eqs. 2-5) by gates. Loss: the lazy quadruplet
(eq. 6), which fell to one code for all places in our hands, or the ranking loss of train.py.
"""
import argparse
import math
import pathlib
import time

import numpy as np
import torch
import torch.nn.functional as F
from scipy.special import lpmv
from torch import nn

from places import draw_batch, open_places, recall
from train import loss_of

BRANCH_OUTPUTS = 512
DESCRIPTOR, SIGNATURE = 1024, 192  # columns of a table
MARGINS = 0.5, 0.2
TEMPERATURE = 0.07
INPUTS = {"point": ("points",), "sphere": ("panorama",), "fused": ("points", "panorama")}


class NetVlad(nn.Module):
    """[n, rows, channels] and the weight of each row -> [n, clusters * channels] of unit length."""

    def __init__(self, channels, clusters):
        super().__init__()
        self.assign = nn.Linear(channels, clusters)
        self.centres = nn.Parameter(torch.randn(clusters, channels) / math.sqrt(channels))

    def forward(self, rows, weight=None):
        shares = self.assign(rows).softmax(2)
        if weight is not None:
            shares = shares * weight[None, :, None]
        sums = shares.transpose(1, 2) @ rows - shares.sum(1)[:, :, None] * self.centres
        return F.normalize(F.normalize(sums, dim=2).flatten(1), dim=1)


class PointBranch(nn.Module):
    """points float [n, 4096, 3] in boxes of 40 m."""

    def __init__(self):
        super().__init__()
        widths = (3, 64, 64, 128, 256)  # the paper's last layer of 1024 would alone need 33 MB behind NetVLAD
        self.layers = nn.Sequential(*(part for i, o in zip(widths, widths[1:])
                                      for part in (nn.Conv1d(i, o, 1, bias=False), nn.BatchNorm1d(o), nn.ReLU())))
        self.pool, self.last = NetVlad(widths[-1], 32), nn.Linear(32 * widths[-1], BRANCH_OUTPUTS)

    def forward(self, points):
        return F.normalize(self.last(self.pool(self.layers(points.transpose(1, 2)).transpose(1, 2))), dim=1)


def sphere_transform(bandwidth, degrees):
    """(analysis [degrees, orders, rows], synthesis [degrees, orders, rows]) of fields sampled at 2 * bandwidth polar angles:
    associated Legendre functions, the former with the weights of Driscoll and Healy."""
    b = bandwidth
    theta = np.pi * (np.arange(2 * b) + 0.5) / (2 * b)
    odd = 2 * np.arange(b) + 1
    weight = 2 / b * np.sin(theta) * (np.sin(theta[:, None] * odd) / odd).sum(1)
    p = np.zeros((degrees, degrees, 2 * b))
    for degree in range(degrees):
        for order in range(degree + 1):
            norm = math.sqrt((2 * degree + 1) / 2 * math.exp(math.lgamma(degree - order + 1) - math.lgamma(degree + order + 1)))
            p[degree, order] = norm * lpmv(order, degree, np.cos(theta))
    return torch.tensor(p * weight, dtype=torch.float32), torch.tensor(p, dtype=torch.float32)


class ZonalConv(nn.Module):
    """Spherical convolution with a filter around the axis: each degree of the spherical harmonics is scaled by itself
    (Esteves et al., ECCV 2018). [n, inputs, 2 b, 2 b] -> [n, outputs, 2 b', 2 b'], batch norm, ReLU."""

    def __init__(self, inputs, outputs, bandwidth, out_bandwidth):
        super().__init__()
        self.size, self.degrees = 2 * out_bandwidth, out_bandwidth
        self.register_buffer("analysis", sphere_transform(bandwidth, out_bandwidth)[0])
        self.register_buffer("synthesis", sphere_transform(out_bandwidth, out_bandwidth)[1])
        self.gain = nn.Parameter(torch.randn(out_bandwidth, inputs, outputs) * math.sqrt(2 / inputs))
        self.norm = nn.BatchNorm2d(outputs)

    def forward(self, x):
        lines = torch.fft.rfft(x, norm="forward")[..., :self.degrees]  # [n, c, rows, orders]
        out = []
        for part in (lines.real, lines.imag):
            degrees = torch.einsum("lmt,nctm->nclm", self.analysis, part)
            out.append(torch.einsum("lmt,nclm->nctm", self.synthesis, torch.einsum("nclm,lcd->ndlm", degrees, self.gain)))
        return F.relu(self.norm(torch.fft.irfft(torch.complex(*out), n=self.size, norm="forward")))


class SphereBranch(nn.Module):
    """panorama float [n, 64, 64] in 0..1."""

    def __init__(self):
        super().__init__()
        channels, bandwidths = (1, 8, 16, 32, 32), (32, 32, 16, 8, 8)
        self.layers = nn.Sequential(*(ZonalConv(*shape) for shape in zip(channels, channels[1:], bandwidths, bandwidths[1:])))
        size = 2 * bandwidths[-1]
        area = torch.sin(torch.pi * (torch.arange(size) + 0.5) / size)
        self.register_buffer("area", area[:, None].expand(size, size).flatten())
        self.pool, self.last = NetVlad(channels[-1], 32), nn.Linear(32 * channels[-1], BRANCH_OUTPUTS)

    def forward(self, panorama):
        rows = self.layers(panorama[:, None]).flatten(2).transpose(1, 2)
        return F.normalize(self.last(self.pool(rows, self.area)), dim=1)


class SelfAttention(nn.Module):
    """Eq. 1: v + gamma softmax(v v^T)^T v."""

    def __init__(self):
        super().__init__()
        self.gamma = nn.Parameter(torch.zeros(1))

    def forward(self, v):
        scaled = v * math.sqrt(v.shape[1])
        return v + self.gamma * ((scaled[:, :, None] * scaled[:, None]).softmax(2).transpose(1, 2) @ v[:, :, None])[:, :, 0]


class Gate(nn.Module):
    """Eqs. 2-5: v times a number in 0..1 for each channel. The correlation of eqs. 2 and 3 comes down to v times a number,
    which goes into the layer."""

    def __init__(self, channels):
        super().__init__()
        self.layer = nn.Linear(channels, channels)

    def forward(self, v):
        correlation = v * v.square().sum(1, keepdim=True) * v.shape[1]
        return v * torch.sigmoid(self.layer(correlation))


class PaperNetwork(nn.Module):
    def __init__(self, branch):
        super().__init__()
        self.branch = branch
        self.branches = nn.ModuleList([{"points": PointBranch, "panorama": SphereBranch}[name]() for name in INPUTS[branch]])
        self.attention = nn.ModuleList([SelfAttention() for _ in self.branches])
        self.gate = Gate(BRANCH_OUTPUTS * len(self.branches))

    def forward(self, inputs):
        codes = [branch(x) for branch, x in zip(self.branches, inputs)]
        if self.branch == "fused":
            return F.normalize(self.gate(torch.cat([attend(v) for attend, v in zip(self.attention, codes)], 1)), dim=1)
        return F.normalize(torch.cat(codes, 1), dim=1)


def load_inputs(places):
    places.points, places.panorama = places.data["points"], places.data["panorama"]
    return places


def look(branch, device, points, panorama):
    """points int16 [n, 4096, 3] in cm, panorama uint8 [n, 64, 64] -> what the branch takes."""
    ready = {"points": lambda: torch.from_numpy(points).to(device).float() / 4000,
             "panorama": lambda: torch.from_numpy(panorama).to(device).float() / 255}
    return [ready[name]() for name in INPUTS[branch]]


def describe(model, places, variant, device):
    """float32 [n, 512 or 1024]."""
    model.eval()
    with torch.no_grad():
        parts = [model(look(model.branch, device, places.points[i:i + 64, variant], places.panorama[i:i + 64, variant])).cpu()
                 for i in range(0, len(places.drive), 64)]
    model.train()
    return torch.cat(parts).numpy()


def quadruplet_loss(code, same, other):
    """Eq. 6, lazy: of each view the farthest positive, the nearest negative, and the nearest two other places."""
    distance = 2 - 2 * code @ code.t()
    near = distance.masked_fill(~same, -1).max(1).values
    negative = distance.masked_fill(~other, 9)
    far, index = negative.min(1)
    between = negative[index].masked_fill(~other, 9).min(1).values  # another place, as seen from that negative
    lost = F.relu(near - far + MARGINS[0]) + F.relu(near - between + MARGINS[1])
    return lost[same.any(1)].mean()


def train(a):
    torch.manual_seed(a.seed)
    rng = np.random.default_rng(a.seed)
    sets, validation = ([load_inputs(open_places(s)) for s in names] for names in (a.sets, a.validation))
    model = PaperNetwork(a.branch).to(a.device)
    optimiser = torch.optim.AdamW(model.parameters(), lr=a.rate, weight_decay=1e-3)
    out = pathlib.Path(a.out)
    out.mkdir(parents=True, exist_ok=True)
    started, best = time.time(), -1
    for step in range(1, a.steps + 1):
        done = max(step / a.steps, (time.time() - started) / 60 / a.minutes)
        for group in optimiser.param_groups:
            group["lr"] = a.rate * min(1, step / 50) * (0.5 * (1 + math.cos(math.pi * min(done, 1))) + 0.01)
        views, same, other = draw_batch(sets, rng, a.neighbourhoods, 8)
        inputs = look(a.branch, a.device, *(np.stack([getattr(s, k)[i, v] for s, i, v in views]) for k in ("points", "panorama")))
        same, other = torch.from_numpy(same).to(a.device), torch.from_numpy(other).to(a.device)
        code = model(inputs)
        loss = (quadruplet_loss(code, same, other) if a.loss == "quadruplet"
                else loss_of(code @ code.t() / TEMPERATURE, same, other))
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        if step % a.every == 0 or step == a.steps or done >= 1:
            scores = {}
            for places in validation:
                code = describe(model, places, 0, a.device)
                scores[pathlib.Path(places.name).stem] = recall(places, code, code)[0]
            chosen = [r for name, r in scores.items() if a.choose_by in name]
            print(f"step {step}, loss {loss.item():.3f}, {time.time() - started:.0f} s; {np.mean(chosen):.4f}; Recall@1 "
                  + ", ".join(f"{name} {r:.3f}" for name, r in scores.items()), flush=True)
            if np.mean(chosen) > best:
                best = np.mean(chosen)
                torch.save({"branch": a.branch, "state": model.state_dict()}, out / f"{a.branch}.pt")
        if done >= 1:
            break


def write_tables(set_file, out, *model_files):
    """The columns of mapweld describe, without orientation."""
    places = load_inputs(open_places(set_file))
    codes = []
    for file in model_files:
        saved = torch.load(file, map_location="cpu")
        model = PaperNetwork(saved["branch"])
        model.load_state_dict(saved["state"])
        codes.append(describe(model, places, 0, "cpu"))
    code = np.concatenate(codes, 1) / math.sqrt(len(codes))
    scale = np.abs(code).max(1) / 127
    numbers = np.zeros((len(code), DESCRIPTOR + SIGNATURE), int)
    numbers[:, :code.shape[1]] = np.rint(code / scale[:, None])
    header = ["scan,x,y,z,scale"] + [f"d{i}" for i in range(DESCRIPTOR)] + [f"o{i}" for i in range(SIGNATURE)]
    for drive in np.unique(places.drive):
        rows = [",".join([str(i), *(f"{v:.4f}" for v in places.position[i]), f"{scale[i]:.9g}", *map(str, numbers[i])])
                for i in np.flatnonzero(places.drive == drive)]
        pathlib.Path(f"{out}.{drive}.csv").write_text("\n".join([",".join(header), *rows, ""]))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--describe", nargs="+", metavar="SET OUT MODEL")
    parser.add_argument("--branch", choices=INPUTS, default="fused")
    parser.add_argument("--sets", nargs="+", default=[])
    parser.add_argument("--validation", nargs="+", default=[])
    parser.add_argument("--choose-by", default="")
    parser.add_argument("-o", "--out", default="build/train")
    parser.add_argument("--steps", type=int, default=3000)
    parser.add_argument("--minutes", type=float, default=1e9)
    parser.add_argument("--neighbourhoods", type=int, default=8)
    parser.add_argument("--loss", choices=("ranking", "quadruplet"), default="ranking")
    parser.add_argument("--rate", type=float, default=1e-3)
    parser.add_argument("--every", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--device", default="cpu")
    a = parser.parse_args()
    write_tables(*a.describe) if a.describe else train(a)


if __name__ == "__main__":
    main()
