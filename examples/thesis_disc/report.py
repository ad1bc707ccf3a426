"""Compares the thesis disc with its references. Usage: report.py SCENE_OUTPUT_DIR

Reads chladni.json and squeal.json, the summaries of the two programs. All references stand here.
"""

import json
import sys
from dataclasses import dataclass
from math import pi
from pathlib import Path

import h5py
import numpy as np

PLATE = "annular Reissner-Mindlin plate, shear factor 5/6, clamped inside, Fourier series in the angle"
TWO_MODES = "linear model of two modes in the inertial frame, with the mode of [1] and the Coriolis forces of its rotary inertia"
KIRCHHOFF = "simulation of two modes with Kirchhoff's mode shape, at 1672.13 Hz, bilateral contact"
SHELLS = "Steinbrecher 2015, section 5.3: Abaqus, S8R shells"
THESIS = "Steinbrecher 2015, section 5.3: Simpack, at 6 pi rad/s"
LINEAR = "Steinbrecher 2015, section 5.1: linear model, with Kirchhoff's mode and frequency"
SYMMETRY = "symmetry: the two modes of a pair have one frequency"
SOURCES = [PLATE, SHELLS, SYMMETRY, TWO_MODES, LINEAR, KIRCHHOFF, THESIS]


@dataclass(frozen=True)
class Figure:
    """A computed number and its reference; `within` is the relative error that a test allows."""

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
    return case["measured_growth_1_s"], case["eigenvalue_growth_1_s"]


def figures(chladni, squeal):
    lower, upper = three_diameters(chladni)
    critical = squeal["critical_speed_rad_s"] / pi
    simulated, eigenvalue = growth(squeal, 6 * pi)
    cycle = squeal["limit_cycle"]
    f, v, z = cycle["frequency_Hz"], cycle["pad_velocity_m_s"], 1e3 * cycle["pad_displacement_m"]
    return [
        Figure("frequency with 3 nodal diameters", "Hz", lower, 1672.0907, PLATE, 1e-3),
        Figure("frequency with 3 nodal diameters", "Hz", lower, 1672.13, SHELLS),
        Figure("upper over lower frequency of the pair", "", upper / lower, 1, SYMMETRY, 0.3 / 1672),
        Figure("critical speed", "pi rad/s", critical, 4.250189, TWO_MODES, 5e-4),
        Figure("critical speed", "pi rad/s", critical, 4.269, LINEAR),
        Figure("growth at 6 pi rad/s, eigenvalue", "1/s", eigenvalue, 2.655781, TWO_MODES, 5e-3),
        Figure("growth at 6 pi rad/s, simulated", "1/s", simulated, 2.655781, TWO_MODES, 5e-3),
        Figure("limit cycle, frequency", "Hz", f, 1696.853, KIRCHHOFF, 2e-3),
        Figure("limit cycle, frequency", "Hz", f, 1696, THESIS),
        Figure("limit cycle, pad velocity", "m/s", v, 6.727, KIRCHHOFF),
        Figure("limit cycle, pad displacement", "mm", z, 0.6309, KIRCHHOFF),
    ]


def read(folder):
    """The summaries of both programs."""
    files = (Path(folder) / f"{program}.json" for program in ("chladni", "squeal"))
    return [json.loads(file.read_text()) for file in files]


def print_table(rows):
    width = max(len(row.name) for row in rows)
    print(f"{'figure':{width}} {'unit':8} {'computed':>10} {'reference':>10}        ratio")
    for row in rows:
        print(
            f"{row.name:{width}} {row.unit:8} {row.computed:10.7g} {row.reference:10.7g} "
            f"[{SOURCES.index(row.source) + 1}] {row.ratio():8.5f}"
        )
    print()
    for number, source in enumerate(SOURCES, start=1):
        print(f"[{number}] {source}")


def free_frequencies(folder):
    """Of the free reduced disc, Hz, ascending; straight from its matrices, without the body.

    With a shift that makes K definite: M x = mu (K + shift M) x, lambda = 1 / mu - shift.
    """
    with h5py.File(next(folder.glob("*.reduced.h5"))) as reduced:
        K, M = reduced["matrices/stiffness"][:], reduced["matrices/mass"][:]
    shift = (2 * np.pi * 100.0) ** 2
    L = np.linalg.cholesky(K + shift * M)
    mu = np.linalg.eigvalsh(np.linalg.solve(L, np.linalg.solve(L, M).T))[::-1]
    return np.sqrt(np.abs(1 / mu[:12] - shift)) / (2 * np.pi)


def rigid_body_ratio(folder):
    """The sixth frequency of the free disc over the seventh, its first elastic one."""
    f = free_frequencies(folder)
    return f[5] / f[6]


def print_rigid_body_ratio(ratio):
    print(f"six rigid-body frequencies of the free disc: below {ratio:.1e} of the first elastic one")


def print_times(summaries):
    for summary in summaries:
        phases = ", ".join(f"{name} {spent:.1f}" for name, spent in summary["phases"].items())
        print(f"{summary['program']}: {summary['wall_s']:.1f} s ({phases})")


if __name__ == "__main__":
    both = read(sys.argv[1])
    print_table(figures(*both))
    print()
    print_rigid_body_ratio(rigid_body_ratio(Path(sys.argv[1])))
    print_times(both)
