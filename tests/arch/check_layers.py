#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Dependencies point one way: an include may only name a folder that the including folder is allowed to see."""
import source_tree

CORE = {
    "base": set(),
    "config": {"base"},
    "geom": {"base"},
    "sensor": {"base", "config"},
    "scan": {"base", "config", "geom", "sensor"},
    "submap": {"base", "config", "geom", "sensor"},
    "lio": {"base", "config", "geom", "sensor", "scan"},
    "nn": {"base"},
    "place": {"base", "config", "geom", "submap", "nn"},
    "correct": {"base", "config", "geom"},
    "pipeline": {"base", "config", "geom", "sensor", "scan", "submap", "lio", "place", "correct"},
}
DRIVERS_SEE = {"core/base", "core/sensor", "core/config"}


def allowed(path, target):
    layer = path.parts[0]
    if layer == "core":
        module, wanted = path.parts[1], target.split("/")
        return wanted[0] == "core" and (wanted[1] == module or wanted[1] in CORE[module])
    if layer == "drivers":
        return target.startswith("drivers/") or any(target.startswith(seen + "/") for seen in DRIVERS_SEE)
    if layer == "firmware-like":
        return target.split("/")[0] in {"core", "drivers", "firmware-like"}
    if layer == "tools":
        return target.split("/")[0] in {"core", "drivers", "tools"}
    return True


problems, checked = [], 0
for file in source_tree.files("core", "drivers", "firmware-like", "tools"):
    path = file.relative_to(source_tree.ROOT)
    for line, target, system in source_tree.includes(file):
        if system:
            if target.startswith("mapweldlcm/") and path.parts[0] == "core":
                problems.append(f"{path}:{line}: core must not know the messages")
            continue
        checked += 1
        if not allowed(path, target):
            problems.append(f"{path}:{line}: {path.parts[0]}/{path.parts[1]} must not include {target}")
source_tree.finish("layers", problems, checked)
