#!/usr/bin/env python3
"""The plan against every single override, at equal time: does what the plan leaves out, and what it does, harm?

    tests/bench/overrides.py build/release/pellucid SCENES -o DIR --time 3 --seeds 2

SCENES is a folder with other people's scenes, laid out as FILES below; those that are missing are said and left out.
A cell is the relMSE without the worst thousandth of the pixels (`relmse_trimmed`), mean over the seeds, and the plain
one, median over them, which single pixels rule that met a lamp by rare chance. Both are times the CPU time that a
render used over the time that it was given, so that neither a loaded machine nor an early stop counts. Where no
reference image stands beside a scene one is made once, into DIR, by `reference`, under a sky by `path`. The last two
columns: the plan over the best of the row by either figure; and the square root of the plan's trimmed relMSE over its
own `error_estimate`, which knows as little of what happens to one pixel in a thousand (1: it knows its error).
"""

import argparse
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys

COLUMNS = {
    "plan": [],
    "path": ["--method", "path"],
    "not adaptive": ["path.adaptive=off"],
    "no caustic map": ["photon.caustic_map=off"],
    "no cache": ["cache.mode=off"],
    "neither": ["photon.caustic_map=off", "cache.mode=off"],
    "chance": ["photon.chance=on"],
    "no split": ["path.split=off"],
    "no guide": ["photon.guiding=off"],
    "no choice": ["cache.choice=off"],
}

# Name: its file, its environment.
FILES = {
    "cornell-box": ("bitterli/cornell-box/cornell-box.glb", None),
    "veach-mis": ("bitterli/veach-mis/veach-mis.glb", None),
    "cbox": ("mitsuba-cbox/cbox.glb", None),
    "causticcube": ("luxcore/causticcube/causticcube.glb", None),
    "cornell-area-caustic": ("luxcore/cornell/cornell-area-caustic.glb", None),
    "LightsPunctualLamp": ("khronos/LightsPunctualLamp/glTF/LightsPunctualLamp.gltf", None),
    "EmissiveStrengthTest": ("khronos/EmissiveStrengthTest/glTF-Binary/EmissiveStrengthTest.glb", None),
}
UNDER_A_SKY = {
    "GlassVaseFlowers": "esplanade",
    "GlassBrokenWindow": "esplanade",
    "TransmissionTest": "esplanade",
    "TransmissionRoughnessTest": "esplanade",
    "AttenuationTest": "esplanade",
    "ClearCoatTest": "sky",
    "MetalRoughSpheresNoTextures": "sky",
    "SpecularTest": "sky",
}
for name, sky in UNDER_A_SKY.items():
    FILES[name] = (f"khronos/{name}/glTF-Binary/{name}.glb", f"envmaps/pmndrs-cc0/{sky}.exr")
for name in ("cornell-glass", "ring", "pool", "goblet", "corridor", "cornell-boxes"):
    FILES[name] = (f"generated/{name}.glb", None)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pellucid", type=pathlib.Path)
    parser.add_argument("scenes", type=pathlib.Path)
    parser.add_argument("-o", dest="folder", type=pathlib.Path, required=True)
    parser.add_argument("--time", type=float, default=3.0)
    parser.add_argument("--reference-time", type=float, default=100.0)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--only", default=",".join(FILES), help="scenes")
    parser.add_argument("--columns", default=",".join(COLUMNS))
    return parser.parse_args()


def render(options, scene, sky, image, size, seconds, seed, extra):
    """CPU time used over that given, and the record."""
    command = [options.pellucid, "render", scene, "-o", image, "--size", size, "--time", seconds, "--seed", seed]
    command += ["--threads", 2, "--quiet", "--record", image.with_suffix(".json")]
    if sky is not None:
        command += ["--env", sky]
    for word in extra:
        command += ["--set", word] if "=" in word else [word]
    before = os.times()
    subprocess.run([str(word) for word in command], check=True, stderr=subprocess.DEVNULL)
    after = os.times()
    used = after.children_user - before.children_user + after.children_system - before.children_system
    record = json.loads(image.with_suffix(".json").read_text())
    return used / (2.0 * seconds), record


def difference(options, reference, image):
    command = [options.pellucid, "diff", reference, image, "--json"]
    answer = subprocess.run([str(word) for word in command], check=True, capture_output=True).stdout
    return json.loads(answer)["images"][0]


def row(options, name, columns):
    file, sky = FILES[name]
    scene = options.scenes / file
    sky = None if sky is None else options.scenes / sky
    if not scene.exists():
        return None
    reference = scene.with_name(scene.stem + ".ref.exr")
    size = "256x256" if reference.exists() else "160x160"
    if not reference.exists():
        reference = options.folder / f"{name}.ref.exr"
        if not reference.exists():
            method = "reference" if sky is None else "path"
            render(options, scene, sky, reference, size, options.reference_time, 99, ["--method", method])
    cells, truth = {}, []
    for column in columns:
        trimmed, plain = [], []
        for seed in range(1, options.seeds + 1):
            image = options.folder / f"{name}.{column.replace(' ', '-')}.{seed}.exr"
            share, record = render(options, scene, sky, image, size, options.time, seed, COLUMNS[column])
            error = difference(options, reference, image)
            trimmed.append(error["relmse_trimmed"] * share)
            plain.append(error["relmse"] * share)
            if column == "plan":
                truth.append(math.sqrt(error["relmse_trimmed"]) / max(1e-9, record["error_estimate"]))
        cells[column] = statistics.mean(trimmed), statistics.median(plain)
    return cells, truth


def main():
    options = arguments()
    options.folder.mkdir(parents=True, exist_ok=True)
    columns = options.columns.split(",")
    print("| scene | " + " | ".join(columns) + " | plan over best | truth over estimate |")
    print("|---" * (len(columns) + 3) + "|")
    for name in options.only.split(","):
        made = row(options, name, columns)
        if made is None:
            print(f"{name}: skipped, not found", file=sys.stderr)
            continue
        cells, truth = made
        best = [min(figures) for figures in zip(*cells.values())]
        over = ", ".join(f"{plan / least:.2f}" for plan, least in zip(cells.get("plan", []), best))
        numbers = " | ".join("{:.1e}, {:.1e}".format(*cells[column]) for column in columns)
        print(f"| {name} | {numbers} | {over} | {', '.join(f'{t:.2f}' for t in truth)} |", flush=True)


if __name__ == "__main__":
    main()
