#!/usr/bin/python3
"""Do the errors that `squeal run` tells hold what finer meshes find? Writes OUTPUT/told_errors.json and .md.

usage: told_errors.py [--quick] [--programs DIR] OUTPUT
       told_errors.py --random COUNT [--seed SEED] [--programs DIR]

Twelve discs on four meshes each, every mesh again with elements of half and of a quarter of the size, under four brakes of
other friction, stiffness and number of pads. Of each mode that grows, and of each critical speed, the error told on the mesh
is compared with the larger one of the differences to the two finer meshes. With --random so many discs, meshes and brakes
are drawn instead, each compared with elements of half the size; nothing is written. Where what is told is less, elements of a
quarter of the size decide which of the two meshes is off: the slopes along a ring of one may be good by chance.
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
# inner radius, outer radius, radius of the ring, thickness (m); Young's modulus, Poisson's ratio, density; band in Hz
DISCS = {
    "thesis": (0.025, 0.162, 0.130, 0.020, 9.2e10, 0.30, 6300.0, 4000.0),
    "thick": (0.070, 0.180, 0.150, 0.030, 1.3e11, 0.25, 7100.0, 6000.0),
    "thin": (0.040, 0.150, 0.120, 0.008, 1.1e11, 0.27, 7150.0, 2500.0),
    "narrow": (0.080, 0.170, 0.145, 0.015, 1.1e11, 0.28, 7100.0, 4500.0),
    "small": (0.030, 0.100, 0.080, 0.010, 1.2e11, 0.27, 7200.0, 6000.0),
    "large": (0.060, 0.220, 0.190, 0.024, 1.0e11, 0.26, 7000.0, 3500.0),
    "steel": (0.047, 0.143, 0.1175, 0.0115, 2.06e11, 0.285, 7830.0, 5000.0),
    "rim": (0.100, 0.165, 0.155, 0.018, 1.1e11, 0.27, 7150.0, 5000.0),
    "wide": (0.020, 0.160, 0.100, 0.014, 1.1e11, 0.27, 7150.0, 3500.0),
    "aluminium": (0.040, 0.140, 0.110, 0.016, 7.0e10, 0.33, 2700.0, 5500.0),
    "bicycle": (0.055, 0.080, 0.072, 0.004, 2.0e11, 0.29, 7900.0, 8000.0),
    "lorry": (0.090, 0.215, 0.180, 0.040, 1.05e11, 0.26, 7100.0, 5000.0),
}
MESHES = ((2, 0.3), (2, 0.2), (3, 0.4), (3, 0.28))  # order, size of the elements as size_of takes it
# friction, stiffness of a pad in N/m, angles of the pads, and what each of them touches
POINT, ROUND = 'face = "point"', "radius = 0.012"
BRAKES = {"one pad": (0.4, 2e7, (10.0,), POINT), "two pads": (0.4, 2e7, (10.0, 100.0), ROUND),
          "soft pad": (0.6, 4e6, (10.0,), ROUND), "two stiff pads": (0.3, 6e7, (10.0, 145.0), POINT)}


def size_of(disc, part):
    """Of a part of the outer radius or, on a narrow disc, of twice its width."""
    inner, outer = DISCS[disc][:2]
    return part * min(outer, 2.0 * (outer - inner))


def scene(disc, order, size, brake, tells):
    inner, outer, radius, thickness, young, poisson, density, up_to_Hz = DISCS[disc]
    friction, stiffness, angles, face = BRAKES[brake]
    pads = ", ".join(f"{{ angle_deg = {angle}, stiffness = {stiffness}, damping = 0.0, preload = 3000.0, {face} }}" for angle in angles)
    return f"""
name = "disc"
[mesh]
generator = "annulus"
inner_radius = {inner}
outer_radius = {outer}
element_order = {order}
element_size = {size:.6g}
rings = [{{ name = "track", radius = {radius}, nodes = 36 }}]
[material.iron]
young = {young}
poisson = {poisson}
density = {density}
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = {thickness}
[[coupling]]
type = "rigid"
name = "hub"
group = "inner_edge"
[interface]
nodes = ["track", "hub"]
[reduce]
tolerance = 1e-4
up_to_Hz = {up_to_Hz}
mesh_errors = {str(tells).lower()}
mass_integrals = false
pictures = "none"
[body]
fixed = ["hub"]
keep = {{ tolerance = 1e-4, up_to_Hz = {up_to_Hz} }}
[squeal]
ring = "track"
thickness = {thickness}
speeds = {{ from_rad_s = 2.0, to_rad_s = 120.0, count = 20 }}
friction = {friction}
pads = [{pads}]
analyses = ["critical-speed", "stability"]
"""


def run(command, folder):
    done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"told_errors.py: {' '.join(map(str, command))}\n{done.stdout}{done.stderr}")


def solved(programs, folder, disc, order, size, brakes, tells=False):
    """What `squeal run` finds of each brake on one mesh."""
    found = {}
    for brake in brakes:
        (folder / "scene.toml").write_text(scene(disc, order, size, brake, tells))
        if not found:
            run([programs / "chladni", "run", "scene.toml", "--output", "out", "--overwrite"], folder)
        run([programs / "squeal", "run", "scene.toml", "--output", "out", "--overwrite", "--json", "found.json"], folder)
        found[brake] = json.loads((folder / "found.json").read_text())
    return found


def growing(found):
    """Frequency, largest growth and its told error of each mode that grows."""
    return [(branch["worst_frequency_Hz"], branch["worst_growth_1_s"], told(branch.get("worst_growth_errors_1_s")))
            for branch in found["stability_table"]["branches"] if branch["worst_growth_1_s"] > 0.0]


def told(errors):
    return sum(part for part in errors.values() if part) if errors and errors["mesh"] is not None else None


def compared(mesh, finer):
    """A row for each number of one brake on one mesh: what it is, its value, the error told, the differences found."""
    rows = []
    error = told(mesh.get("critical_speed_errors_rad_s"))
    speeds = [each.get("critical_speed_rad_s") for each in (mesh, *finer)]
    if error is not None and all(speed is not None for speed in speeds):
        rows.append({"of": "critical speed, rad/s", "value": speeds[0], "told": error,
                     "found": [abs(speed - speeds[0]) for speed in speeds[1:]]})
    others = [growing(each) for each in finer]
    for frequency, growth, error in growing(mesh):
        same = [min(other, key=lambda row: abs(row[0] - frequency), default=None) for other in others]
        if error is None or any(row is None or abs(row[0] / frequency - 1.0) > 0.01 for row in same):
            continue
        rows.append({"of": "growth, 1/s", "frequency_Hz": frequency, "value": growth, "told": error,
                     "found": [abs(row[1] - growth) for row in same]})
    return rows


def draw(seed):
    """A disc and a brake of their own, in DISCS and BRAKES by their name; order and size of the elements."""
    dice = np.random.default_rng(seed)
    name = f"seed {seed}"
    outer, young = dice.uniform(0.08, 0.25), dice.uniform(7e10, 2.1e11)
    inner, poisson, density = outer * dice.uniform(0.15, 0.65), dice.uniform(0.25, 0.33), dice.uniform(2600.0, 7900.0)
    width, wave_speed = outer - inner, np.sqrt(young / density)
    thickness = width * dice.uniform(0.06, 0.25)
    up_to_Hz = round(thickness * wave_speed * max(1.5 / outer**2, 0.25 / width**2))
    DISCS[name] = (inner, outer, inner + width * dice.uniform(0.6, 0.85), thickness, young, poisson, density, up_to_Hz)
    angles = tuple(round(angle, 1) for angle in dice.uniform(0.0, 360.0, dice.integers(1, 3)))
    BRAKES[name] = (dice.uniform(0.2, 0.7), 10.0 ** dice.uniform(6.5, 7.9), angles,
                    POINT if dice.random() < 0.4 else f"radius = {width * dice.uniform(0.05, 0.14):.5f}")
    order = int(dice.integers(2, 4))
    return name, order, size_of(name, dice.uniform(0.2, 0.3) if order == 2 else dice.uniform(0.28, 0.4))


def try_random(programs, folder, count, seed):
    """Whether no error told of so many draws is below the difference found."""
    rows = []
    for each in range(seed, seed + count):
        name, order, size = draw(each)

        def of(part):
            return solved(programs, folder, name, order, size / part, [name], tells=part == 1)[name]

        mesh = of(1)
        new = compared(mesh, [of(2)])
        if any(row["told"] < max(row["found"]) for row in new):
            print(f"{name}: told less than elements of half the size find; those of a quarter:", flush=True)
            new = compared(mesh, [of(4)])
        for row in new:
            if row["told"] < max(row["found"]):
                print(f"{name}: {row['of']} {row['value']:.6g}: told {row['told']:.3g}, found {max(row['found']):.3g}; "
                      f"order {order}, {size:.4g} m, disc {DISCS[name]}, brake {BRAKES[name]}", flush=True)
        rows += new
    print(f"{count} discs from seed {seed} on, told over found: {spread(rows).replace(' |', ',')} between 1 and 10")
    return bool(rows) and ratios(rows).min() >= 1.0


def measure(programs, folder, quick, keep):
    """Rows so far are kept after each mesh."""
    brakes = list(BRAKES)[:2] if quick else list(BRAKES)
    rows = []
    for disc in list(DISCS)[:2] if quick else DISCS:
        for order, part in MESHES[2:3] if quick else MESHES:
            size = size_of(disc, part)
            mesh = solved(programs, folder, disc, order, size, brakes, tells=True)
            finer = [solved(programs, folder, disc, order, size / parts, brakes) for parts in (2, 4)]
            for brake in brakes:
                for row in compared(mesh[brake], [each[brake] for each in finer]):
                    rows.append({"disc": disc, "order": order, "size": size, "brake": brake} | row)
            of_mesh = ratios([row for row in rows if (row["disc"], row["order"], row["size"]) == (disc, order, size)])
            print(f"{disc}, order {order}, {size:.4f} m: {len(of_mesh)} numbers, {of_mesh.min(initial=np.inf):.2f} to {of_mesh.max(initial=0):.2f}", flush=True)
            keep({"rows": rows})
    return {"rows": rows}


def ratios(rows):
    """Told over found; what differs by less than a millionth of the value is rounding."""
    return np.array([row["told"] / max(*row["found"], 1e-6 * abs(row["value"])) for row in rows])


def spread(rows):
    of = ratios(rows)
    return (f"{len(of)} | {of.min():.2f} | {np.median(of):.2g} | {np.quantile(of, 0.9):.2g} | {of.max():.2g} | "
            f"{100 * np.mean((of >= 1.0) & (of <= 10.0)):.0f} %")


def page(result):
    rows = result["rows"]
    lines = ["# Printed errors of growth rates and critical speeds", "",
             f"{len({row['disc'] for row in rows})} discs on {len(MESHES)} meshes each, under "
             f"{len({row['brake'] for row in rows})} brakes with one and two pads, friction of 0.3 to 0.6 and pads of 4 to 60 kN/mm. The table",
             "has the ratio of the error that `squeal run` prints on a mesh ([its parts](../explanation/squeal.md#the-error-of-a-critical-speed)) to the larger one of the differences to meshes of half and of a quarter of",
             "the element size, for every mode that grows and every critical speed. Written by `benchmarks/squeal/told_errors.py`.", "",
             "| printed over found | numbers | least | median | nine of ten below | largest | between 1 and 10 |", "| --- | --- | --- | --- | --- | --- | --- |"]
    for name in ("growth, 1/s", "critical speed, rad/s"):
        some = [row for row in rows if row["of"] == name]
        if some:
            lines.append(f"| {name.split(',')[0]} | {spread(some)} |")
    lines.append(f"| all | {spread(rows)} |")
    lines += ["", "| disc | numbers | least | median | nine of ten below | largest | between 1 and 10 |", "| --- | --- | --- | --- | --- | --- | --- |"]
    for disc in dict.fromkeys(row["disc"] for row in rows):
        lines.append(f"| {disc} | {spread([row for row in rows if row['disc'] == disc])} |")
    lines += ["", "| mesh | numbers | least | median | nine of ten below | largest | between 1 and 10 |", "| --- | --- | --- | --- | --- | --- | --- |"]
    for order, part in MESHES:
        some = [row for row in rows if row["order"] == order and row["size"] == size_of(row["disc"], part)]
        if some:
            lines.append(f"| order {order}, {part:g} of the outer radius | {spread(some)} |")
    lines += ["", "| pads | numbers | least | median | nine of ten below | largest | between 1 and 10 |", "| --- | --- | --- | --- | --- | --- | --- |"]
    for face, said in ((POINT, "touch a point"), (ROUND, "round, of 12 mm radius")):
        some = [row for row in rows if BRAKES[row["brake"]][3] == face]
        if some:
            lines.append(f"| {said} | {spread(some)} |")
    return "\n".join(lines + [""])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/release/bin")
    parser.add_argument("--random", type=int, default=0, metavar="COUNT")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("output", type=pathlib.Path, nargs="?")
    wanted = parser.parse_args()
    if wanted.random > 0:
        with tempfile.TemporaryDirectory() as name:
            holds = try_random(wanted.programs.resolve(), pathlib.Path(name), wanted.random, wanted.seed)
        sys.exit(0 if holds else "told_errors.py: FAILED: an error told is less than what a finer mesh finds")
    if wanted.output is None:
        parser.error("where shall the page go? Name OUTPUT")
    wanted.output.mkdir(parents=True, exist_ok=True)

    def keep(result):
        rows = ",\n".join(json.dumps(row) for row in result["rows"])
        (wanted.output / "told_errors.json").write_text(f'{{"rows": [\n{rows}\n]}}\n')
        (wanted.output / "told_errors.md").write_text(page(result))

    with tempfile.TemporaryDirectory() as name:
        result = measure(wanted.programs.resolve(), pathlib.Path(name), wanted.quick, keep)
    least = ratios(result["rows"]).min()
    if least < 1.0:
        sys.exit(f"told_errors.py: FAILED: an error told is {least:.2f} times what a finer mesh finds")


if __name__ == "__main__":
    main()
