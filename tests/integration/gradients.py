"""Gradients of critical speed and growth against differences, for every number of [squeal] that is one of the brake.

Usage: gradients.py PROGRAM_DIR
"""

import re
import sys
import tempfile
import tomllib
from pathlib import Path

from running import run, summary

DISC = """
name = "disc"
[mesh]
generator = "annulus"
inner_radius = 0.025
outer_radius = 0.162
element_order = 3
element_size = 0.03
rings = [{ name = "track", radius = 0.13, nodes = 24 }]
[material.iron]
young = 9.15915e10
poisson = 0.3
density = 6300.0
loss_factor = 4e-4
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = 0.02
[[coupling]]
type = "rigid"
name = "hub"
group = "inner_edge"
[interface]
nodes = ["hub", "track"]
[reduce]
method = "craig-bampton"
modes = 30
[body]
fixed = ["hub"]
keep = { modes = 14 }
"""

SQUEAL = """
[squeal]
ring = "track"
contact_planes = [-0.0101, 0.01]
speeds = { from_rad_s = 1.0, to_rad_s = 80.0, count = 40 }
contact = "bilateral"
analyses = ["gradients"]
gradients = { speed_rad_s = 45.0 }
[squeal.friction]
kinetic = 0.5
static = 0.6
decay_speed = 2.0
regularisation = 0.01
[[squeal.pads]]
angle_deg = 10.0
stiffness = 6e6
damping = 4.0
preload = 2000.0
cubic_stiffness = 1e12
grid = { sector_deg = 20.0, points = 3 }
shim = { stiffness = 4e7, loss_factor = 0.1, frequency_Hz = 1700.0 }
[squeal.pads.body]
mass = 0.3
height = 0.01
radial = { stiffness = 3e7, damping = 20.0 }
tangential = { stiffness = 2e8, damping = 200.0 }
axial = { stiffness = 5e6, damping = 30.0 }
about_tangential = { inertia = 1e-4, stiffness = 2e3, damping = 0.05 }
[squeal.pads.caliper]
mass = 3.0
stiffness = 4e6
damping = 10.0
[[squeal.pads]]
angle_deg = 120.0
stiffness = 5e6
damping = 1.0
preload = 1500.0
area = 2e-3
[squeal.pads.friction]
temperature_C = 170.0
factor = 1.1
[[squeal.pads.friction.table]]
temperature_C = 100.0
pressure_Pa = 2e5
speed_m_s = [0.01, 3.0, 12.0]
mu = [0.5, 0.47, 0.44]
[[squeal.pads.friction.table]]
temperature_C = 100.0
pressure_Pa = 2e6
speed_m_s = [0.01, 3.0, 12.0]
mu = [0.48, 0.44, 0.41]
[[squeal.pads.friction.table]]
temperature_C = 300.0
pressure_Pa = 2e5
speed_m_s = [0.01, 3.0, 12.0]
mu = [0.45, 0.43, 0.41]
[[squeal.pads.friction.table]]
temperature_C = 300.0
pressure_Pa = 2e6
speed_m_s = [0.01, 3.0, 12.0]
mu = [0.43, 0.4, 0.38]
"""

# Numbers of the study, integers, points of a table (measured: its factor is varied), and what changes no small motion.
NOT_OF_THE_BRAKE = re.compile(
    r"squeal\.(speeds|gradients)\.|\.points$|\.table\[\d+\]\.|\.cubic_stiffness$"
)

failures = []


def numbers(value, path):
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from numbers(inner, f"{path}.{key}")
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            yield from numbers(inner, f"{path}[{i + 1}]")
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path, float(value)


class Brake:
    def __init__(self, programs, folder):
        self.programs, self.folder = programs, folder
        (folder / "scene.toml").write_text(DISC + SQUEAL)
        run(programs / "chladni", "run", folder / "scene.toml", "--output", folder)

    def gradients(self):
        return summary(self.programs / "squeal", "run", self.folder / "scene.toml", "--output", self.folder)["gradients"]


def main(programs):
    with tempfile.TemporaryDirectory() as folder:
        brake = Brake(programs, Path(folder))
        found = brake.gradients()
        rows = {"squeal." + row["key"]: row for row in found["rows"]}
        of_brake = [(key, value) for key, value in numbers(tomllib.loads(SQUEAL)["squeal"], "squeal")
                    if not NOT_OF_THE_BRAKE.search(key)]  # fmt: skip
        print(f"{len(of_brake)} numbers, critical speed {found['critical_speed_rad_s']} rad/s")
        for key, value in of_brake:
            if key not in rows:
                failures.append(f"{key} has no gradient")
                continue
            if abs(rows[key]["value"] / value - 1) > 1e-12:
                failures.append(f"{key} is {value}, and its row says {rows[key]['value']}")
            check(brake, key, rows[key], found)
    if failures:
        sys.exit("FAILED: " + "; ".join(failures))


def results_with(brake, key, value):
    """The gradients of the scene with another value of a key, from its text."""
    text = text_with(DISC + SQUEAL, key, value)
    (brake.folder / "scene.toml").write_text(text)
    return brake.gradients()


def text_with(text, key, value):
    """The scene with another number, found by reading each candidate back."""
    wanted = dict(numbers(tomllib.loads(text)["squeal"], "squeal"))
    old = wanted[key]
    for match in re.finditer(r"(?<![\w.])-?\d+(\.\d+)?(e-?\d+)?(?![\w.])", text):
        if float(match.group()) != old:
            continue
        candidate = text[: match.start()] + repr(value) + text[match.end() :]
        now = dict(numbers(tomllib.loads(candidate)["squeal"], "squeal"))
        if now == wanted | {key: value}:
            return candidate
    raise SystemExit(f"FAILED: {key} is not in the text")


def check(brake, key, row, found):
    """Central differences of two steps, extrapolated; their distance tells how good they are."""
    value, h = row["value"], 1e-3 * abs(row["value"])
    at = {k: results_with(brake, key, value + k * h) for k in (-2, -1, 1, 2)}

    def difference(of):
        near, far = (of(at[1]) - of(at[-1])) / (2 * h), (of(at[2]) - of(at[-2])) / (4 * h)
        return (4 * near - far) / 3, abs(near - far)

    for name, exact, of, size in (
        ("critical speed", row["critical_speed_by_value"], lambda r: r["critical_speed_rad_s"], found["critical_speed_rad_s"]),
        ("growth", row["growth_by_value"][0], lambda r: r["motions"][0]["growth_1_s"], 2 * 3.14 * found["motions"][0]["frequency_Hz"]),
    ):  # fmt: skip
        estimate, doubt = difference(of)
        # Rounding of the eigenvalues, 1e-12 of them, over the step; the truncation is bounded by the two steps.
        limit = 1e-5 * abs(estimate) + 0.1 * doubt + 1e-11 * size / h
        good = abs(exact - estimate) <= limit
        print(f"{'ok    ' if good else 'FAILED'} {name} by {key}: {exact:.6g}, differences {estimate:.6g} +- {limit:.1g}")
        if not good:
            failures.append(f"{name} by {key}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
