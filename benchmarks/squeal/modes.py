#!/usr/bin/python3
"""How many modes does a critical speed need?

usage: modes.py [--quick] [--programs DIR] RESULT.json

The disc of examples/thesis_disc, meshed and reduced, and of its body the lowest modes alone, one pair or
single mode more at a time: the first speed at which the disc becomes unstable, and that at which the pair with three
nodal diameters does, which squeals in the source. Two discs: the iron one of 20 mm, and one with the same D and mass
per area a hundredth as thick, which has neither shear flexibility nor rotary inertia: that of the references, which
were computed without this code from the closed form of the Kirchhoff plate; of the thick disc that of the pair alone is
known, of the Mindlin plate. The contact planes are 20 mm apart on both. Fails where a reference is missed.
"""
import argparse
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
THICKNESS, THINNER = 0.02, 100.0
ALONE = 0  # in place of a number of groups: the pair with three nodal diameters and no other
# Critical speed over pi of the pair with three nodal diameters, by the number of groups kept, and of all below
# 16 kHz the first critical speed of any.
BRANCH_REFERENCE = {ALONE: 4.271898407, 4: 4.507899264, 8: 4.435464332, 16: 4.442456483, 19: 4.447933676}
FIRST_REFERENCE = {19: 4.028040537}
MINDLIN_REFERENCE = {ALONE: 4.235183338}  # of the pair of the thick disc, exact Mindlin mode
SPEEDS = (0.2, 8.0, 157)  # from, to, over pi; count


def replaced(text, pattern, by):
    """The text with its only match of the pattern exchanged."""
    new, n = re.subn(pattern, by, text)
    if n != 1:
        raise SystemExit(f"modes.py: examples/thesis_disc/scene.toml has {n} times: {pattern}")
    return new


def scene(thinner, size, fixed_modes, up_to_Hz):
    """That of the example with a plate `thinner` times as thin, of the same D and mass per area."""
    text = (ROOT / "examples/thesis_disc/scene.toml").read_text()
    text = text[:text.index("[sound]")]
    text = replaced(text, r"element_size = .*", f"element_size = {size!r}")
    text = replaced(text, r"young = .*", f"young = {9.15915e10 * thinner**3!r}")
    text = replaced(text, r"density = .*", f"density = {6300.0 * thinner!r}")
    text = replaced(text, r'(material = "iron"\n)thickness = .*', rf"\g<1>thickness = {THICKNESS / thinner!r}")
    text = replaced(text, r"modes = 100", f"modes = {fixed_modes}\nmass_integrals = false")
    text = replaced(text, r"keep = .*", f"keep = {{ up_to_Hz = {up_to_Hz!r} }}")
    text = replaced(text, r"interface_modes = .*\n", "")
    text = re.sub(r"\n(growth|transient) = .*", "", text)
    first, last, count = SPEEDS
    text = replaced(text, r"speeds = \{.*", f"speeds = {{ from_rad_s = {first * math.pi!r}, to_rad_s = {last * math.pi!r}, "
                                            f"count = {count} }}")
    return replaced(text, r"analyses = .*", 'analyses = ["eigenvalues", "critical-speed"]')


def run(program, command, folder):
    """Runs a program on folder/scene.toml; returns its summary."""
    words = [program, command, folder / "scene.toml", "--output", folder, "--json", folder / "summary.json"]
    done = subprocess.run(list(map(str, words)), env=ENVIRONMENT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{program} {command}: {done.stderr}")
    return json.loads((folder / "summary.json").read_text())


def groups_of(body):
    """Modes of a body that bend it, pairs together: {numbers from 1, f_Hz, nodal diameters}."""
    import h5py
    with h5py.File(body) as file:
        f_Hz = file["modes/frequencies"][:] / (2 * math.pi)
        ring = file["rings/track"]
        power = ring["displacement_cosine"][:] ** 2 + ring["displacement_sine"][:] ** 2
    groups = []
    for i in np.flatnonzero(power.sum(0) > 1e-8 * power.sum(0).max()):
        n = int(power[:, i].argmax())
        if n and groups and groups[-1]["n"] == n and f_Hz[i] < groups[-1]["f_Hz"] * 1.01:
            groups[-1]["numbers"].append(int(i) + 1)
        else:
            groups.append({"n": n, "f_Hz": float(f_Hz[i]), "numbers": [int(i) + 1]})
    return [group for group in groups if len(group["numbers"]) == (2 if group["n"] else 1)]  # the last may be cut in two


def branch_of(result, f_Hz):
    """(critical speed / pi, growth at 6 pi) of the least stable motion within a twentieth of a frequency: of the pair
    whose frequency it is in the free disc. Without one, None."""
    import h5py
    with h5py.File(result) as file:
        speeds = file["eigenvalues/speeds"][:] / math.pi
        growth, omega = file["eigenvalues/lambda_re"][:], file["eigenvalues/lambda_im"][:]
    near = np.abs(omega / (2 * math.pi * f_Hz) - 1) < 0.05
    if not near.any(1).all():
        return None
    largest = np.where(near, growth, -np.inf).max(1)
    at_6_pi = float(np.interp(6.0, speeds, largest))
    crossing = np.flatnonzero((largest[:-1] < 0) & (largest[1:] >= 0) & (speeds[:-1] > 2))
    if not len(crossing):
        return None, at_6_pi
    i = slice(crossing[0] - 1, crossing[0] + 3)  # the cubic speed(growth) through the four points around
    a, g = speeds[i], largest[i]
    weights = [np.prod([g[m] / (g[m] - g[j]) for m in range(4) if m != j]) for j in range(4)]
    return float(np.dot(weights, a)), at_6_pi


def with_modes(programs, folder, text, kept, f_Hz):
    """Critical speeds of the body with the groups of modes `kept` alone."""
    numbers = sorted(number for group in kept for number in group["numbers"])
    (folder / "scene.toml").write_text(
        replaced(text, r'use_modes = "[^"]*"', f"use_modes = {numbers}"))
    summary = run(programs / "squeal", "run", folder)
    first = summary.get("critical_speed_rad_s")
    has_pair = any(group["n"] == 3 and group["f_Hz"] == f_Hz for group in kept)
    branch, growth = (has_pair and branch_of(folder / "disc.squeal.h5", f_Hz)) or (None, None)
    return {"modes": len(numbers), "highest_Hz": max(group["f_Hz"] for group in kept),
            "critical_over_pi": first and first / math.pi, "critical_Hz": summary.get("critical_frequency_Hz"),
            "branch_over_pi": branch, "branch_growth_6_pi": growth, "cpu_s": summary["cpu_s"]}


def measure(programs, thinner, quick):
    """All rows of one disc."""
    text = scene(thinner, *((0.02, 40, 5000.0) if quick else (0.009, 150, 16000.0)))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "scene.toml").write_text(text)
        reduction = run(programs / "chladni", "run", folder)
        groups = groups_of(folder / "disc.body.h5")
        pair = next(group for group in groups if group["n"] == 3)
        rows = []
        for count in (ALONE, *range(1, len(groups) + 1)):
            kept = groups[:count] if count else [pair]
            row = with_modes(programs, folder, text, kept, pair["f_Hz"])
            branch, first = (BRANCH_REFERENCE, FIRST_REFERENCE) if thinner > 1 else (MINDLIN_REFERENCE, {})
            rows.append({"groups": count, **row, "branch_reference": branch.get(count), "first_reference": first.get(count)})
    return {"thickness_m": THICKNESS / thinner, "dofs": reduction["n_dofs"], "reduction_cpu_s": reduction["cpu_s"], "rows": rows}


def largest_difference(discs):
    """From the references, relative."""
    pairs = [(row[own], row[reference]) for disc in discs for row in disc["rows"]
             for own, reference in (("branch_over_pi", "branch_reference"), ("critical_over_pi", "first_reference"))
             if row[reference]]
    return max((abs(own / reference - 1) if own else math.inf for own, reference in pairs), default=math.inf)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/release/bin")
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    discs = [measure(arguments.programs, thinner, arguments.quick) for thinner in (THINNER, 1.0)]
    result = {"speeds": SPEEDS[2], "discs": discs, "largest_difference": largest_difference(discs)}
    arguments.output.write_text(json.dumps(result, indent=1))
    limit = 1e-2 if arguments.quick else 1e-3
    return 0 if result["largest_difference"] < limit else f"{result['largest_difference']:.1e} off the references"


if __name__ == "__main__":
    sys.exit(main())
