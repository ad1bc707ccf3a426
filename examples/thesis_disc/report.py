"""Compares the thesis disc with its references. Usage: report.py SCENE_OUTPUT_DIR

Reads chladni.json and squeal.json, the summaries of the two programs. All references stand here.
"""

import json
import sys
from dataclasses import dataclass
from math import pi
from pathlib import Path

PLATE = "annular Reissner-Mindlin plate, shear factor 5/6, Fourier series in the angle"
TWO_MODES = "two-mode model in the inertial frame with that plate's mode"
KIRCHHOFF = "two-mode model with Kirchhoff's mode at 1672.13 Hz, bilateral contact"
THESIS = "Steinbrecher 2015, section 5.3"


@dataclass(frozen=True)
class Figure:
    """One computed number beside its reference; `within` is the relative error that a test allows."""

    name: str
    unit: str
    computed: float
    reference: float
    source: str
    within: float | None = None

    def ratio(self):
        return self.computed / self.reference


def three_diameters(chladni):
    """The pair of frequencies with three nodal diameters: the two closest to the plate's."""
    return sorted(sorted(chladni["frequencies_Hz"], key=lambda f: abs(f - 1672.0907))[:2])


def growth(squeal, speed):
    """Growth rates at the computed speed next to this one: of the simulation, of the eigenvalue."""
    case = min(squeal["growth"], key=lambda case: abs(case["speed_rad_s"] - speed))
    return case["growth_1_s"], case["eigenvalue_growth_1_s"]


def figures(chladni, squeal):
    lower, upper = three_diameters(chladni)
    cycle = squeal["limit_cycle"]
    critical = squeal["critical_speed_rad_s"] / pi
    simulated, eigenvalue = growth(squeal, 6 * pi)
    return [
        Figure("frequency, 3 nodal diameters", "Hz", lower, 1672.0907, PLATE, 1e-3),
        Figure("the same", "Hz", lower, 1672.13, THESIS + ".2, Abaqus S8R"),
        Figure("its twin over it", "1", upper / lower, 1.0, "symmetry", 0.3 / 1672),
        Figure("critical speed / pi", "rad/s", critical, 4.23518, TWO_MODES, 5e-3),
        Figure("the same", "rad/s", critical, 4.269, THESIS + ".4, Kirchhoff's mode"),
        Figure("growth at 6 pi rad/s, eigenvalue", "1/s", eigenvalue, 2.68534, TWO_MODES),
        Figure("the same, simulated", "1/s", simulated, 2.68534, TWO_MODES),
        Figure("squeal frequency", "Hz", cycle["frequency_Hz"], 1696.853, KIRCHHOFF, 2e-3),
        Figure("the same", "Hz", cycle["frequency_Hz"], 1696.0, THESIS + ".4"),
        Figure("pad velocity", "m/s", cycle["pad_velocity_m_s"], 6.727, KIRCHHOFF),
        Figure("pad displacement", "mm", 1e3 * cycle["pad_displacement_m"], 0.6309, KIRCHHOFF),
    ]


def read(folder):
    return [json.loads((Path(folder) / f"{name}.json").read_text()) for name in ("chladni", "squeal")]


def print_table(rows):
    width = max(len(row.name) for row in rows)
    print(f"{'figure':{width}}  {'computed':>10} {'reference':>10} {'unit':5} {'ratio':>8}  source")
    for row in rows:
        print(
            f"{row.name:{width}}  {row.computed:10.6g} {row.reference:10.6g} {row.unit:5} "
            f"{row.ratio():8.5f}  {row.source}"
        )


def print_times(summaries):
    for summary in summaries:
        phases = ", ".join(f"{name} {spent:.2f}" for name, spent in summary["phases"].items())
        print(f"{summary['program']}: {summary['wall_s']:.1f} s ({phases})")


if __name__ == "__main__":
    summaries = read(sys.argv[1])
    print_table(figures(*summaries))
    print()
    print_times(summaries)
