#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the table of robust_bench: plot_robust.py TABLE.json OUT.png. Needs matplotlib (package python3-matplotlib)."""
import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

table, out = sys.argv[1:3]
rows = json.load(open(table))
seeds = rows[0]["seeds"]
figure, axes = plt.subplots(1, 3, figsize=(13, 4.2))


def draw(axis, scenario, method, label, style):
    chosen = [row for row in rows if row["scenario"] == scenario and row["method"] == method]
    axis.plot([100 * row["wrong_share"] for row in chosen], [row["mean_ratio"] for row in chosen], style, label=label,
              markersize=4)


STYLES = {"Mapweld": "o-", "DCS alone": "s--", "Huber": "^:", "least squares": "v:"}
for axis, scenario, title in ((axes[0], "known frames", "frames known"), (axes[1], "unknown frames", "frames unknown")):
    for method, style in STYLES.items():
        draw(axis, scenario, method, method, style)
    axis.set_title(f"{title}, wrong loops on their own")
for group, style in ((3, "o-"), (5, "s-"), (10, "^-"), (20, "v-")):
    draw(axes[2], f"unknown, groups of {group}", "Mapweld", f"groups of {group}", style)
axes[2].set_title("frames unknown, wrong loops that agree")
for axis in axes:
    axis.axhline(1.2, color="0.6", linewidth=1)
    axis.set_yscale("log")
    axis.set_xlabel("wrong loops, % of all")
    axis.grid(alpha=0.3)
    axis.legend(fontsize=8)
axes[0].set_ylabel("error / error without wrong loops")
figure.suptitle(f"Three vehicles, mean over {seeds} seeds; grey: 1.2", fontsize=10)
figure.tight_layout()
figure.savefig(out, dpi=110)
