#!/usr/bin/python3
"""How small may the bodies of a brake be, and for what other brake do they serve? Writes OUTPUT/condensed_bodies.json and .md.

usage: condensed_bodies.py [--quick] [--programs DIR] OUTPUT

The brake of examples/brake with bodies of many modes: complex eigenvalues up to 3 kHz with the large bodies and with those that
`squeal condense` makes of them, for several tolerances; then with friction, speeds and springs that the small ones do not know.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples/brake"
UP_TO_HZ = 3000.0
TOLERANCES = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4)
CHANGED_FOR = 1e-3
CHANGES = {
    "none": (),
    "friction 0.3": (("friction = 0.5", "friction = 0.3"),),
    "friction 0.7": (("friction = 0.5", "friction = 0.7"),),
    "speeds 10 to 100 rad/s": (("from_rad_s = 30.0, to_rad_s = 60.0", "from_rad_s = 10.0, to_rad_s = 100.0"),),
    "pressure 3 MPa": (("pressure = 1e6", "pressure = 3e6"),),
    "lining half as stiff": (("stiffness_per_area = 2e10", "stiffness_per_area = 1e10"),),
    "lining twice as stiff": (("stiffness_per_area = 2e10", "stiffness_per_area = 4e10"),),
    "piston half as stiff": (("z = 6e7", "z = 3e7"),),
    "bracket half as stiff": (("x = 2e7, y = 6e7", "x = 1e7, y = 3e7"),),
}
RINGS = ", ".join(f'{{ kind = "irm", at = "{ring}", dofs = ["z", "rx", "ry"] }}' for ring in ("inner", "track", "outer"))
KEEP = {"disc": f"keep = {{ modes = 30 }}\ninterface_modes = [{RINGS}]\n", "pad": "keep = { modes = 120 }\n",
        "caliper": "keep = { modes = 38 }\n"}


def run(command, folder):
    done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"condensed_bodies.py: {' '.join(map(str, command))}\n{done.stdout}{done.stderr}")


def changed(text, changes):
    for old, new in changes:
        if old not in text:
            sys.exit(f"condensed_bodies.py: {old!r} is not in the scene")
        text = text.replace(old, new)
    return text


def scene(changes=(), small=False):
    text = changed((EXAMPLE / "scene.toml").read_text(), changes)
    text = re.sub(r"\nanalyses = .*", '\nanalyses = ["eigenvalues"]', re.sub("count = 16", "count = 2", text))
    return re.sub(r'(name = "(\w+)"[^\n]*\nbody = )"[^"]+"', r'\1"brake.condensed/\2.body.h5"', text) if small else text


def make_bodies(programs, folder):
    for file in EXAMPLE.glob("*"):
        shutil.copy(file, folder)
    for name, keep in KEEP.items():
        text = (EXAMPLE / f"{name}.toml").read_text()
        damping = "".join(re.findall(r"damping = .*\n?", text))
        (folder / f"{name}.toml").write_text(text[: text.index("keep = ")] + keep + damping)
        run([programs / "chladni", "run", f"{name}.toml", "--output", "out", "--overwrite"], folder)


def eigenvalues(programs, folder, text):
    (folder / "scene.toml").write_text(text)
    begin = time.perf_counter()
    run([programs / "squeal", "run", "scene.toml", "--output", "out", "--overwrite"], folder)
    seconds = time.perf_counter() - begin
    with h5py.File(folder / "out/brake.squeal.h5") as file:
        return file["eigenvalues/lambda_re"][:] + 1j * file["eigenvalues/lambda_im"][:], seconds


def band(values):
    end = 2 * np.pi * UP_TO_HZ
    return values[(values.imag > 0) & (values.imag <= end)]


def errors(exact, found):
    """Of all eigenvalues of the band at all speeds: relative distance of the nearest one."""
    return np.concatenate([[abs(b - one).min() / abs(one) for one in band(a)] for a, b in zip(exact, found, strict=True)])


def condense(programs, folder, tolerance):
    (folder / "scene.toml").write_text(scene())
    run([programs / "squeal", "condense", "scene.toml", "--output", "out", "--overwrite", "--up-to-Hz", UP_TO_HZ,
         "--tolerance", tolerance, "--json", "condense.json"], folder)
    return json.loads((folder / "condense.json").read_text())


def compare(programs, folder, changes):
    exact, slow = eigenvalues(programs, folder, scene(changes))
    found, fast = eigenvalues(programs, folder, scene(changes, small=True))
    off = errors(exact, found)
    return {"largest": off.max(), "median": float(np.median(off)), "invented": errors(found, exact).max(),
            "growth": max(band(a).real.max() for a in exact), "growth_small": max(band(a).real.max() for a in found),
            "seconds": slow, "seconds_small": fast}


def measure(programs, folder, quick):
    make_bodies(programs, folder)
    sizes = []
    for tolerance in TOLERANCES[:2] if quick else TOLERANCES:
        told = condense(programs, folder, tolerance)
        parts = {part["part"]: part["coordinates"] for part in told["parts"]}
        sizes.append({"tolerance": tolerance, "told": told["error"], "parts": parts}
                     | compare(programs, folder, ()))
    before = sum(part["coordinates_before"] for part in told["parts"])
    condense(programs, folder, CHANGED_FOR)
    chosen = dict(list(CHANGES.items())[:2]) if quick else CHANGES
    return {"before": before, "sizes": sizes, "changed_for": CHANGED_FOR,
            "changes": {name: compare(programs, folder, changes) for name, changes in chosen.items()}}


def page(result):
    names = list(result["sizes"][0]["parts"])
    lines = ["# Small bodies for one brake", "",
             "`squeal condense` makes small bodies of the large ones of an assembly ([how](../how-to/several_bodies.md#small-bodies-for-one-brake)). The brake of",
             f"`examples/brake`, its bodies with {result['before']} coordinates together, complex eigenvalues up to {UP_TO_HZ:g} Hz at both ends of the speeds.",
             "Errors are relative distances to the eigenvalues of the large bodies. Written by `benchmarks/squeal/condensed_bodies.py`.", "",
             "| tolerance | " + " | ".join(names) + " | all | printed error | largest error | median | time of `squeal run`, large over small |",
             "| --- |" + " --- |" * (len(names) + 5)]
    for row in result["sizes"]:
        sizes = [row["parts"][name] for name in names]
        lines.append(f"| {row['tolerance']:g} | " + " | ".join(map(str, sizes)) + f" | {sum(sizes)} | {row['told']:.1e} | {row['largest']:.1e} | "
                     f"{row['median']:.1e} | {row['seconds'] / row['seconds_small']:.0f} |")
    lines += ["", "## For another brake", "",
              f"The bodies of the tolerance {result['changed_for']:g} in brakes that they were not made for. They know friction from none to the scene's 0.5 and its speeds.", "",
              "| change | largest error | median | error of what is found | largest growth, 1/s | with small bodies |",
              "| --- | --- | --- | --- | --- | --- |"]
    for name, row in result["changes"].items():
        lines.append(f"| {name} | {row['largest']:.1e} | {row['median']:.1e} | {row['invented']:.1e} | {row['growth']:.4g} | {row['growth_small']:.4g} |")
    lines += ["", "Where springs at the edge of a plate change, the patterns under the lining do: condense again, or check with the large bodies.", ""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/release/bin")
    parser.add_argument("output", type=pathlib.Path)
    wanted = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        result = measure(wanted.programs.resolve(), pathlib.Path(name), wanted.quick)
    wanted.output.mkdir(parents=True, exist_ok=True)
    (wanted.output / "condensed_bodies.json").write_text(json.dumps(result, indent=1) + "\n")
    (wanted.output / "condensed_bodies.md").write_text(page(result))


if __name__ == "__main__":
    main()
