#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The streets to train on: towns.py FOLDER [--smoke] writes a scenario for each and prints one job a line,

    NAME PART SCENARIO.json VEHICLES LIDAR

the parts of a name being drives of one town. Towns whose name begins with held_ are for choosing the weights, not for training.
"""
import argparse
import json
import pathlib
import shutil

DATA = pathlib.Path(__file__).resolve().parents[1] / "sim/data"
SENSORS = ("vlp16", "vlp16", "hdl32e", "vlp16", "vlp16", "os1-64", "vlp16")
#         style       towns, first seed, side m, drives, km in all
INVENTED = (("old_town", 5, 311, 800, 6, 6), ("suburb", 6, 331, 850, 6, 6), ("industry", 4, 351, 1000, 4, 5),
            ("estate", 3, 371, 800, 4, 5), ("plaza", 3, 391, 420, 6, 1.5))
HELD = (("old_town", 319, 700, 4, 3), ("suburb", 339, 700, 4, 3), ("industry", 359, 900, 4, 3), ("plaza", 399, 420, 6, 1.5))
LIECHTENSTEIN_DRIVES, LIECHTENSTEIN_ZONES = 30, 5


def invented(style, seed, side, drives, km):
    metres = 1000 * km
    return {"name": f"train {style} {seed}", "about": "Streets to train on, invented.",
            "town": {"style": style, "size_m": side, "seed": seed}, "relief_m": 1 + seed % 4, "traffic": 0.3 + seed % 3 * 0.4,
            "rain_share": 0.15, "max_speed_mps": 4 if style == "plaza" else 14, "seed": seed,
            "survey": {"drives": drives, "zones": 1, "zone_radius_m": side * (0.66 if side < 500 else 0.48),
                       "min_length_m": 0.7 * metres / drives, "max_length_m": 1.5 * metres / drives,
                       "total_length_m": metres}}


def scenarios():
    """(name, scenario, sensor, drives of each part)"""
    every = [(f"{style}_{seed + i}", invented(style, seed + i, *shape))
             for style, towns, seed, *shape in INVENTED for i in range(towns)]
    for i, (name, scenario) in enumerate(every):
        drives = scenario["survey"]["drives"]
        yield name, scenario, SENSORS[i % len(SENSORS)], [range(1, drives // 2 + 1), range(drives // 2 + 1, drives + 1)]
    for style, seed, *shape in HELD:
        yield f"held_{style}_{seed}", invented(style, seed, *shape), "vlp16", [range(1, shape[1] + 1)]
    with open(DATA / "train_town.json") as file:
        liechtenstein = json.load(file)
    for zone in range(1, LIECHTENSTEIN_ZONES + 1):
        drives = list(range(zone, LIECHTENSTEIN_DRIVES + 1, LIECHTENSTEIN_ZONES))
        yield f"liechtenstein_{zone}", liechtenstein, "vlp16", [[d] for d in drives]


def smoke():
    yield "suburb_331", invented("suburb", 331, 500, 2, 1), "vlp16", [range(1, 3)]
    yield "held_suburb_339", invented("suburb", 339, 500, 2, 1), "vlp16", [range(1, 3)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--smoke", action="store_true")
    a = parser.parse_args()
    a.folder.mkdir(parents=True, exist_ok=True)
    for name, scenario, sensor, parts in smoke() if a.smoke else scenarios():
        if isinstance(scenario["town"], str):  # an extract lies beside its scenario
            shutil.copy(DATA / scenario["town"], a.folder)
        file = a.folder / f"{name}.json"
        file.write_text(json.dumps(scenario, indent=1))
        for part, drives in enumerate(parts):
            print(name, part, file, ",".join(map(str, drives)), sensor)


if __name__ == "__main__":
    main()
