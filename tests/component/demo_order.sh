#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The main job in two orders of arrival: one group, within a metre of the truth, no heap call, the same trajectories.
# usage: demo_order.sh SOURCE_DIR WORK_DIR
set -euo pipefail
source_dir=$1 work=$2
for order in 1,2,3,4 3,1,4,2; do
  "$source_dir/tools/demo" --order "$order" --out "$work/$order"
done
for file in "$work"/1,2,3,4/trajectory_* "$work"/1,2,3,4/group_1/*; do
  other="$work/3,1,4,2/${file#"$work"/1,2,3,4/}"
  cmp "$file" "$other"
done
python3 - "$work/1,2,3,4/summary.json" <<'PY'
import json, sys
summary = json.load(open(sys.argv[1]))
assert summary["groups"] == 1, summary["groups"]
assert all(error <= 1.0 for error in summary["rmse_m"].values()), summary["rmse_m"]
assert summary["heap_calls_after_boot"] == 0, summary["heap_calls_after_boot"]
assert len(summary["drives"]) == 4
print("one group of 4, rmse", summary["rmse_m"])
PY
