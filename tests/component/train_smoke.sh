#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Trains a tiny place descriptor from nothing, twice: both must give the same model. train_smoke.sh SOURCE WORK
set -euo pipefail
source_dir=$1
work=$2
if ! /usr/bin/python3 -c "import torch, scipy" 2>/dev/null; then
  echo "skipped: no PyTorch here; tools/install_deps training brings it"
  exit 77
fi
rm -rf "$work"
"$source_dir/tools/train/run" --smoke -o "$work"
cp "$work/place.mwm" "$work/first.mwm"
rm "$work"/*.pt
"$source_dir/tools/train/run" --smoke -o "$work"
cmp "$work/first.mwm" "$work/place.mwm"
