#!/usr/bin/python3
"""Does every scene that asks for an accuracy get it, what does it cost, and how near is the error that is told to the true one?

usage: accuracy.py [--quick | --by-hand] [--programs DIR] [--only NAME ...] [--errors ERROR ...] OUTPUT

Each geometry of accuracy_scenes.py is asked for three errors. Its frequencies are compared with those of a finer mesh by `chladni modes`, or
with closed forms: all of the range, by their place in the order. Writes OUTPUT/accuracy.json and .md. With --only or --errors the others stay as they were. With --quick a few of
these are tried, and none may be refused; without OUTPUT nothing is written. Ends with an error where an accuracy is not kept. With --by-hand the rows of
OUTPUT/accuracy.json get the CPU time of the best choice by hand: of the meshes of generators that were chosen for this or a smaller error, the one with fewest DOFs, with
the same tolerances of the reduction and of the responses.
"""
import argparse
import json
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

import h5py
import numpy as np

from accuracy_scenes import GEOMETRIES

ROOT = pathlib.Path(__file__).resolve().parents[2]
ERRORS = (1e-2, 1e-3, 1e-4)
QUICK = {1e-2: ("disc on a hub", "cantilever plate", "plate, edges loaded", "one of twelve sectors", "cantilever beam",
                "plate of a .msh", "plate of a deck")}
MOST_CPU_S = 120


def call(command, folder):
    """(exit code, what it printed, CPU seconds)."""
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (MOST_CPU_S, MOST_CPU_S + 5))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, check=False, preexec_fn=limit)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done.returncode, done.stdout + done.stderr, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def true_frequencies(programs, folder, geometry):
    """Hz, up to somewhat above the range."""
    if geometry.exact:
        return np.array(geometry.exact(1.1 * geometry.up_to_Hz))
    for count in (60, 200):
        (folder / "fine.toml").write_text(geometry.fine_scene(count))
        code, printed, _ = call([programs / "chladni", "modes", "fine.toml", "--output", "fine", "--overwrite", "--json", "fine.json"], folder)
        if code != 0:
            sys.exit(f"accuracy.py: FAILED: the finer mesh: {printed[-500:]}")
        found = np.array(json.loads((folder / "fine.json").read_text())["frequencies_Hz"])
        if found[-1] > 1.05 * geometry.up_to_Hz:
            return found[found > 1.0]
    sys.exit("accuracy.py: FAILED: the finer mesh has too many modes in the range")


def refusal(code, printed):
    """What an error says, without the place of the scene."""
    if code < 0:
        return f"no answer within {MOST_CPU_S} CPU seconds"
    return re.sub(r"^(?:error: )?\S*scene\.toml:(?:\d+:)? ?", "", printed.strip().splitlines()[-1])


def answered(programs, folder, geometry, error):
    """What the scene gives for one error."""
    (folder / "scene.toml").write_text(geometry.scene(error))
    code, printed, cpu_s = call([programs / "chladni", "run", "scene.toml", "--output", "out", "--overwrite", "--json", "summary.json"], folder)
    row = {"asked": error, "cpu_s": round(cpu_s, 2)}
    if code != 0:
        return {**row, "refused": refusal(code, printed)}
    with h5py.File(folder / "out/body.reduced.h5") as file:
        certificate = {name: np.array(file[f"certificate/{name}"]) for name in ("frequencies", "estimates", "mesh_errors")}
    note = re.search(r"Hz: (.*?); estimated error of the mesh", printed)
    n = len(certificate["mesh_errors"])
    return {**row, "frequencies_Hz": list(certificate["frequencies"][:n] / (2 * np.pi)),
            "told": list(certificate["estimates"][:n] + certificate["mesh_errors"]), "mesh": note[1] if note else "",
            "dofs": json.loads((folder / "summary.json").read_text())["n_dofs"]}


def by_hand(geometry, error, mesh):
    """The scene with a mesh that a note tells; nothing where the mesh is one of a file."""
    if "generator" not in geometry.mesh or (size := re.fullmatch(r"((?:\w+ = [\d.e+-]+(?:, )?)+)", mesh)) is None:
        return None
    keys = size[1].split(", ")
    if "annulus" in geometry.mesh or "hat_disc" in geometry.mesh:
        keys += [] if "sectors" in geometry.mesh else ['sectors = "auto"']
    tolerance = f"tolerance = {{}}\nup_to_Hz = {geometry.up_to_Hz!r}\n"
    scene = geometry.scene(error).replace("[mesh]\n", "[mesh]\n" + "\n".join(keys) + "\n")
    scene = re.sub(r"accuracy = .*\n", "", scene).replace("\n[body]\n", "\n[reduce]\n" + tolerance.format(0.2 * error) + "\n[body]\n")
    return scene + f"keep = {{ tolerance = {error!r}, up_to_Hz = {geometry.up_to_Hz!r} }}\n"


def times_by_hand(programs, rows, wanted):
    """Adds them to the rows."""
    for row in rows:
        if "true" not in row or row["geometry"] not in wanted.get(row["asked"], ()):
            continue
        geometry = GEOMETRIES[row["geometry"]]
        meshes = [r for r in rows if r["geometry"] == row["geometry"] and "true" in r and r["true"] <= row["asked"] and r["asked"] <= row["asked"]]
        best = min(meshes, key=lambda r: r["dofs"])
        scene = by_hand(geometry, row["asked"], best["mesh"])
        if scene is None:
            continue
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            geometry.beside(folder)
            (folder / "scene.toml").write_text(scene)
            command = [programs / "chladni", "run", "scene.toml", "--output", "out", "--overwrite"]
            code, printed, cpu_s = call(command, folder)
            if code != 0:
                sys.exit(f"accuracy.py: FAILED: {row['geometry']} by hand: {printed[-500:]}")
        row["by_hand_s"] = round(cpu_s, 2)
        print(f"{row['geometry']} at {row['asked']:.0e}: {row['cpu_s']} s, by hand {row['by_hand_s']} s with {best['mesh']}", flush=True)


def judged(row, true_Hz, up_to_Hz):
    """The largest true error of the range and the largest one told; a missing frequency shifts all behind it."""
    in_range = int(np.sum(true_Hz <= up_to_Hz * (1.0 - row["asked"])))
    found, told = np.array(row.pop("frequencies_Hz")), np.array(row.pop("told"))
    if len(found) < in_range:
        return {**row, "true": 1.0, "told": float(told.max()), "modes": in_range}
    true = np.abs(found[:in_range] / true_Hz[:in_range] - 1.0)
    return {**row, "true": float(true.max()), "told": float(told[:in_range].max()), "modes": in_range}


def measured(programs, wanted, keep=lambda rows: None):
    """Rows of the geometries that are wanted for each error. Each is kept when it is there."""
    rows, true_Hz = [], {}
    for error, names in wanted.items():
        for name in names:
            geometry = GEOMETRIES[name]
            with tempfile.TemporaryDirectory() as folder:
                folder = pathlib.Path(folder)
                geometry.beside(folder)
                row = answered(programs, folder, geometry, error)
                if "refused" not in row:
                    if name not in true_Hz:
                        true_Hz[name] = true_frequencies(programs, folder, geometry)
                    row = judged(row, true_Hz[name], geometry.up_to_Hz)
            rows.append({"geometry": name, "judge": "closed form" if geometry.exact else "finer mesh", **row})
            print(json.dumps(rows[-1]), flush=True)
            keep(rows)
    return rows


def told_over_true(row):
    """What differs by less than a part in 1e7 is rounding, also of the finer mesh."""
    return row["told"] / max(row["true"], 1e-7)


def failures(rows):
    return [row for row in rows if "true" in row and row["true"] > row["asked"]]


def page(rows):
    given = [row for row in rows if "true" in row]
    ratios = np.array([told_over_true(row) for row in given] or [np.nan])
    lines = ["# One accuracy for every scene", "",
             "Scenes that say `accuracy = { error = ..., up_to_Hz = ... }` and neither elements nor modes, written by `benchmarks/end_to_end/accuracy.py`. Of",
             "all frequencies of the range, the largest error that is told (mesh and reduction) and the largest true one, against a mesh of much smaller "
             "elements", "of order 3 or 4, or closed forms. A frequency that is missing would shift all behind it. `over by hand`: CPU seconds over those of the "
             "same tolerances", "with the smallest of the meshes that were chosen for this or a smaller error.", "",
             f"{len(given)} of {len(rows)} scenes got an answer, of which {len(given) - len(failures(rows))} keep the error that was asked for. The error "
             f"that is told is {ratios.min():.2g} to {ratios.max():.2g} times", f"the true one, {np.median(ratios):.2g} in the median, "
             f"and at most five times in {100 * np.mean(ratios <= 5.0):.0f} % of these.", "",
             "| geometry | asked | true | told | told over true | holds | modes | DOFs | CPU, s | over by hand | judge |", "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    for row in given:
        lines.append(f"| {row['geometry']} | {row['asked']:.0e} | {row['true']:.1e} | {row['told']:.1e} | {told_over_true(row):.2g} | "
                     f"{'yes' if row['true'] <= row['asked'] else '**no**'} | {row['modes']} | {row['dofs']} | {row['cpu_s']:.1f} | "
                     f"{format(row['cpu_s'] / row['by_hand_s'], '.1f') if 'by_hand_s' in row else '-'} | {row['judge']} |")
    missing = [f"{name} at {error:.0e}" for name in GEOMETRIES for error in ERRORS if (name, error) not in {(row["geometry"], row["asked"]) for row in rows}]
    if missing:
        lines += ["", f"Not tried yet: {', '.join(missing)}."]
    lines += ["", "## Refused", "", "| geometry | asked | CPU, s | why |", "| --- | --- | --- | --- |"]
    lines += [f"| {row['geometry']} | {row['asked']:.0e} | {row['cpu_s']:.1f} | {row['refused']} |" for row in rows if "refused" in row]
    lines += ["", "## What was chosen", "", "| geometry | asked | mesh |", "| --- | --- | --- |"]
    lines += [f"| {row['geometry']} | {row['asked']:.0e} | {row['mesh']} |" for row in given]
    return "\n".join(lines + [""])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--by-hand", action="store_true")
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/release/bin")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME")
    parser.add_argument("--errors", nargs="+", type=float, default=ERRORS, metavar="ERROR")
    parser.add_argument("output", type=pathlib.Path, nargs="?")
    wanted = parser.parse_args()
    if wanted.output is None and not wanted.quick:
        parser.error("where shall the page go? Name OUTPUT")
    asked = QUICK if wanted.quick else {error: wanted.only or list(GEOMETRIES) for error in wanted.errors}
    path = wanted.output / "accuracy.json" if wanted.output else None
    known = json.loads(path.read_text())["rows"] if path and path.exists() and (wanted.only or wanted.errors != ERRORS) else []
    others = [row for row in known if row["geometry"] not in asked.get(row["asked"], ())]

    def keep(rows):
        if wanted.output is None:
            return
        rows = sorted(others + rows, key=lambda row: (list(GEOMETRIES).index(row["geometry"]), -row["asked"]))
        wanted.output.mkdir(parents=True, exist_ok=True)
        (wanted.output / "accuracy.json").write_text('{"rows": [\n' + ",\n".join(map(json.dumps, rows)) + "\n]}\n")
        (wanted.output / "accuracy.md").write_text(page(rows))

    if wanted.by_hand:
        rows = json.loads(path.read_text())["rows"]
        times_by_hand(wanted.programs.resolve(), rows, asked)
        others = []
        keep(rows)
        return
    rows = measured(wanted.programs.resolve(), asked, keep)
    for row in failures(rows):
        print(f"accuracy.py: FAILED: {row['geometry']} at {row['asked']}: the true error is {row['true']:.2e}")
    refused = [row for row in rows if "refused" in row and wanted.quick]
    for row in refused:
        print(f"accuracy.py: FAILED: {row['geometry']} at {row['asked']} is refused: {row['refused']}")
    sys.exit(1 if failures(rows) or refused else 0)


if __name__ == "__main__":
    main()
