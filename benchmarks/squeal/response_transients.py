#!/usr/bin/python3
"""What do response modes cost a transient? CPU time without them, with them condensed into the contact, and with their inertia.

usage: response_transients.py [--quick] [--programs DIR] OUTPUT

The disc of examples/thesis_disc with the 40 modes that it ships with, and with axial response modes at its ring beside them: one
transient each, in turn, several times over. Condensed is what `squeal` does by default; with inertia is
quasi_static_above_Hz beyond all modes. What the condensed body lacks is in response_modes.md. Writes OUTPUT/response_transients.json and .md.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import tempfile

import h5py

from response_modes import ENVIRONMENT, RESPONSES, ROOT, replaced, run, scene

KINDS = {"none": ("none", ""), "condensed": ("axial", ""), "with inertia": ("axial", "quasi_static_above_Hz = 1e7\n")}


def scene_of(kind, duration, quick):
    """The scene of the example with a transient of all modes."""
    responses, static = KINDS[kind]
    text = replaced(scene(100, 1e4, RESPONSES[responses]), r"keep = .*", "keep = { modes = 40 }")
    if quick:
        text = replaced(text, r"element_size = .*", "element_size = 0.03")
    transient = f"transient = {{ speed_rad_s = 18.8495559, duration_s = {duration}, initial_pad_displacement = 1e-6 }}\n"
    return replaced(text, r"analyses = .*", 'analyses = ["transient"]\n' + static + transient)


def cpu_of(words, folder):
    """CPU seconds of a program."""
    before = os.times()
    done = subprocess.run(list(map(str, words)), env=ENVIRONMENT, capture_output=True, text=True, check=False, cwd=folder)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, words))}: {done.stderr}")
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def simulate(programs, folder, text):
    """CPU seconds, integrator, steps and number of coordinates with inertia of one run."""
    (folder / "scene.toml").write_text(text)
    cpu_s = cpu_of([programs / "squeal", "run", "scene.toml", "--overwrite", "--json", "squeal.json"], folder)
    with h5py.File(folder / "disc.squeal.h5") as file:
        n_steps = int(file["transient/steps"][()])
    integrator = json.loads((folder / "squeal.json").read_text())["integrator"]
    (folder / "scene.toml").write_text(text.replace('analyses = ["transient"]', 'analyses = ["eigenvalues"]'))
    cpu_of([programs / "squeal", "run", "scene.toml", "--overwrite"], folder)
    with h5py.File(folder / "disc.squeal.h5") as file:
        coordinates = file["eigenvalues/mode_numbers"].size
    return {"cpu_s": cpu_s, "integrator": integrator, "coordinates": coordinates, "n_steps": n_steps}


def measure(programs, work, durations, repetitions, quick):
    """The runs of each kind, taken in turn so that a load of the machine meets all alike."""
    folders = {kind: work / kind.replace(" ", "_") for kind in KINDS}
    for kind, folder in folders.items():
        folder.mkdir()
        (folder / "scene.toml").write_text(scene_of(kind, durations[kind], quick))
        source = work / "none" / "disc.reduced.h5"
        if source.exists():
            os.link(source, folder / "disc.reduced.h5")
        run([programs / "chladni", "body" if source.exists() else "run", "scene.toml", "--overwrite"], folder)
    runs = {kind: [] for kind in KINDS}
    for _ in range(repetitions):
        for kind, folder in folders.items():
            runs[kind].append(simulate(programs, folder, scene_of(kind, durations[kind], quick)))
    return runs


def table(result):
    """The page."""
    rows = "\n".join(f"| {row['kind']} | {row['coordinates']} | {row['integrator']} | {row['n_steps'] / row['duration_s']:.3g} | {row['duration_s']:g} | {row['cpu_s']:.2f} | "
                     f"{row['cpu_per_s']:.3g} |" for row in result["rows"])
    return f"""# What response modes cost a transient

Written by `benchmarks/squeal/response_transients.py`; no number here was typed. The disc of `examples/thesis_disc`, its 40
modes, one pad pair, {result['repetitions']} runs of each kind in turn, medians of the CPU time of the whole program.

| response modes | coordinates with inertia | integrator | steps in a second | simulated, s | CPU, s | CPU for a simulated second, s |
| --- | --- | --- | --- | --- | --- | --- |
{rows}

Condensed into the contact, response modes cost a transient {result['condensed_over_none']:.2f} times what it costs without them; with their inertia,
whose frequencies rule the steps, it costs {result['inertia_over_condensed']:.0f} times as much as condensed.
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/release/bin")
    parser.add_argument("output", type=pathlib.Path)
    wanted = parser.parse_args()
    long, short, repetitions = (0.05, 0.002, 1) if wanted.quick else (1.0, 0.02, 5)
    durations = {kind: short if kind == "with inertia" else long for kind in KINDS}
    with tempfile.TemporaryDirectory() as name:
        runs = measure(wanted.programs.resolve(), pathlib.Path(name), durations, repetitions, wanted.quick)
    rows = []
    for kind, each in runs.items():
        cpu_s = statistics.median(run["cpu_s"] for run in each)
        rows.append({"kind": kind, **each[0], "duration_s": durations[kind], "cpu_s": cpu_s, "cpu_per_s": cpu_s / durations[kind],
                     "all_cpu_s": [run["cpu_s"] for run in each]})
    none, condensed, inertia = rows
    result = {"rows": rows, "repetitions": repetitions, "condensed_over_none": condensed["cpu_per_s"] / none["cpu_per_s"],
              "inertia_over_condensed": inertia["cpu_per_s"] / condensed["cpu_per_s"]}
    wanted.output.mkdir(parents=True, exist_ok=True)
    (wanted.output / "response_transients.json").write_text(json.dumps(result, indent=1) + "\n")
    (wanted.output / "response_transients.md").write_text(table(result))
    print(table(result))


if __name__ == "__main__":
    main()
