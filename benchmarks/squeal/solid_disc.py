#!/usr/bin/python3
"""The disc of examples/thesis_disc as a shell and as a solid, side by side: frequencies, and the squeal of one pair.

usage: solid_disc.py [--quick] OUTPUT

Both discs are clamped at the bore, the shell at its inner edge, the solid at the face of the bore, and rub between the same
pads. The exact frequencies are those of the Reissner-Mindlin plate and of three-dimensional elasticity
(benchmarks/elements/exact_annulus.py, exact_solid.py). What the pair with three nodal diameters feels of the pads is read
from the bodies: the deflection of a face at the ring, the displacement of the face around the axis there, and beside it half
the thickness times the slope, which is what a plate makes of it. Writes OUTPUT/solid_disc.json and .md.
"""
import argparse
import json
import math
import pathlib
import re
import sys
import tempfile

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks/reduction"))
import run  # noqa: E402

HALF, RING = 0.01, 0.13
SPEEDS = (4.5, 6.0, 10.0)  # over pi, of the growth


def changed(text, *changes):
    for pattern, by in changes:
        text, n = re.subn(pattern, by, text)
        if n != 1:
            raise SystemExit(f"solid_disc.py: the scene has {n} times: {pattern}")
    return text


def squeal_table(name):
    """Both rub at z = -0.01 and 0.01 m."""
    ring = ('ring = "track"\nthickness = 0.02' if name == "shell" else
            'ring = { inboard = "lower", outboard = "upper" }\ncontact_planes = [-0.01, 0.01]')
    first, last, count = math.pi, SPEEDS[-1] * math.pi, 19  # half of pi apart
    return f"""[squeal]
{ring}
use_modes = "nodal-diameters 3"
speeds = {{ from_rad_s = {first!r}, to_rad_s = {last!r}, count = {count} }}
friction = 0.6
contact = "bilateral"
pads = [{{ angle_deg = 0.0, stiffness = 6e6, damping = 0.0, preload = 2000.0 }}]
analyses = ["eigenvalues", "critical-speed"]
"""


def scene(name, size):
    text = (ROOT / "examples/solid_disc/scene.toml").read_text()
    text = text[:text.index("[squeal]")]
    text = changed(text, (r"element_size = \S+.*", f"element_size = {size!r}"), (r'name = "solid_disc"', f'name = "{name}"'),
                   (r"modes = 40\n\n", "modes = 80\n\n"))
    if name == "shell":
        text = changed(text, (r"extrude = .*\n", ""), (r"rings = \[[^\]]*\]", 'rings = [{ name = "track", radius = 0.13, nodes = 30 }]'),
                       (r'type = "solid"', 'type = "shell"\nthickness = 0.02'), (r'"upper", "lower", "hub"', '"track", "hub"'))
    return text + squeal_table(name)


def growth(found, speed):
    """1/s, the largest real part at the listed speed that is nearest."""
    nearest = min(found["eigenvalues"], key=lambda one: abs(one["speed_rad_s"] - speed))
    return max(real for real, _ in nearest["lambda"])


def pair_of(body, ring, omega):
    """Of the pair of modes near a frequency: rms around the ring of deflection, displacement around the axis, and slope."""
    with h5py.File(body) as file:
        modes = [int(i) for i in np.argsort(np.abs(file["modes/frequencies"][:] - omega))[:2]]
        nodes = file[f"rings/{ring}/nodes"][:]
        angles = file[f"rings/{ring}/angles"][:]
        shapes = file["modes/attachment_displacements"][:][:, modes].reshape(-1, 6, 2)[nodes]
    c, s = np.cos(angles)[:, None], np.sin(angles)[:, None]
    around, slope = c * shapes[:, 1] - s * shapes[:, 0], c * shapes[:, 3] + s * shapes[:, 4]
    rms = lambda values: float(np.sqrt(np.mean(values**2)))
    return {"deflection": rms(shapes[:, 2]), "around": rms(around), "slope": rms(slope)}


def measure(folder, name, size, exact):
    path = folder / f"{name}.toml"
    path.write_text(scene(name, size))
    reduced = run.summary(run.CHLADNI, "run", path, folder)
    found = run.summary(run.CHLADNI.parent / "squeal", "run", path, folder)
    with h5py.File(folder / f"{name}.body.h5") as file:
        f_Hz = list(file["modes/frequencies"][:] / (2 * math.pi))
    squeal_omega = 2 * math.pi * min(f_Hz, key=lambda f: abs(f - found["critical_frequency_Hz"]))
    pair = pair_of(folder / f"{name}.body.h5", "track" if name == "shell" else "upper", squeal_omega)
    if name == "shell":
        pair["around"] = HALF * pair["slope"]  # of the face: the normal turns
        pair["other_face"] = pair["deflection"]  # the normal keeps its length
    else:
        pair["other_face"] = pair_of(folder / f"{name}.body.h5", "lower", squeal_omega)["deflection"]
        pair["slope"] = 3 / RING * pair["deflection"]  # of the face, along the ring
    return {"dofs": reduced.get("n_dofs"), "f_Hz": f_Hz[:len(exact)], "error": run.errors_of(f_Hz[:len(exact)], exact),
            "critical_speed": found["critical_speed_rad_s"], "critical_Hz": found["critical_frequency_Hz"],
            "growth": [growth(found, speed * math.pi) for speed in SPEEDS], "pair_Hz": squeal_omega / (2 * math.pi), "pair": pair}


def table(result):
    shell, solid, exact = result["shell"], result["solid"], result["exact"]
    lines = ["# One disc as a shell and as a solid", "",
             "The disc of `examples/thesis_disc`, clamped at the bore and between its pads, as a shell of 20 mm and as hexahedra of order 3. "
             "Written by `benchmarks/squeal/solid_disc.py`.", "", f"Commit {result['machine']['commit']}.", "",
             "| frequency, Hz | shell | exact plate | solid | exact solid | exact solid over plate |", "|---" * 6 + "|"]
    for i in range(0, len(shell["f_Hz"])):
        plate, elastic = exact["plate"][i], exact["solid"][i]
        lines.append(f"| {i + 1} | {shell['f_Hz'][i]:.2f} | {plate:.2f} | {solid['f_Hz'][i]:.2f} | {elastic:.2f} | {elastic / plate:.4f} |")
    row = lambda label, key, digits: f"| {label} | {key(shell):.{digits}} | {key(solid):.{digits}} | {key(solid) / key(shell):.4f} |"
    errors = "; ".join(f"{name} {r['error']['median']:.1e} ({r['error']['largest']:.1e} at most), {r['dofs']:,} DOFs" for name, r in (("shell", shell), ("solid", solid)))
    lines += ["", f"Errors against the exact frequencies of the same theory: {errors}."]
    lines += ["", "| squeal of the pair with three nodal diameters | shell | solid | solid over shell |", "|---" * 4 + "|",
              row("frequency of the pair, Hz", lambda r: r["pair_Hz"], "2f"),
              row("critical speed, rad/s", lambda r: r["critical_speed"], "4f"),
              row("its frequency, Hz", lambda r: r["critical_Hz"], "2f"),
              *(row(f"growth at {speed} pi rad/s, 1/s", lambda r, i=i: r["growth"][i], "4f") for i, speed in enumerate(SPEEDS)),
              row("deflection of the ring, m per unit of q (rms)", lambda r: r["pair"]["deflection"], "5f"),
              row("deflection of the lower face over that of the upper", lambda r: r["pair"]["other_face"] / r["pair"]["deflection"], "6f"),
              row("displacement of a face around the axis there", lambda r: r["pair"]["around"], "6f"),
              row("that over half the thickness times the slope of the deflection", lambda r: r["pair"]["around"] / (HALF * 3 / RING * r["pair"]["deflection"]), "4f")]
    lines += ["", "- **Frequencies.** Each model approaches the exact ones of its own theory, and the last column is what lies between the theories. The bore of the solid is held as a face, "
              "on which the shear of a plate cannot warp the section, and the plate's as an edge: modes with few nodal diameters, which bend at the bore, are higher as a solid. The stress at the "
              "edges of a held face has no limit, so that meshes of solids come nearer slowly there: the largest errors are those of modes that bend at the bore.",
              "- **Thickness.** Both discs are 20 mm thick. The pair bends, so that both faces of the solid deflect alike, and the thickness does not change in the contact.",
              "- **Contact plane.** Both discs rub at z = -10 mm and 10 mm. There a plate moves by its deflection and by the turn of its normal, and the solid has nodes.",
              "- **Shear.** How far a face moves around the axis as it leans turns friction into work. Normals of the plate turn by the slope of the deflection less an even shear, and the face of "
              "the solid moves as the elastic body does, whose shear vanishes at the faces: the last row has both beside the slope alone.",
              "- **Critical speed and growth** follow from these rows: frequency, deflection under the pads, and displacement around the axis. Near the critical speed growth is a small "
              "difference of larger terms, and differs by more than they do."]  # fmt: skip
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    size, count = (0.024, 7) if arguments.quick else (0.012, 20)
    exact = {"plate": list(map(float, run.exact_frequencies("annulus", count))), "solid": list(map(float, run.exact_frequencies("solid", count)))}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        result = {"machine": run.machine(), "exact": exact, "shell": measure(folder, "shell", size, exact["plate"]),
                  "solid": measure(folder, "solid", size, exact["solid"])}
    run.publish(arguments.output, "solid_disc", result, table(result))
    print(table(result))


if __name__ == "__main__":
    main()
