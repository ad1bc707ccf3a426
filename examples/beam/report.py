"""Compares the beam example with its references. Usage: report.py OUT

The references in reference.json come from 60-digit arithmetic. Reads what study.py left in OUT.
"""

import sys
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

import beam
from figures import frequency_errors

# Relative deviation that the test allows: round-off of eigenvectors, 1e-8 and less, in errors down to 1e-5
# of the response; the references have six digits or more.
ROUND_OFF = 1e-5


@dataclass(frozen=True)
class Row:
    """A computed number and its reference; `within` is the relative deviation that a test allows."""

    name: str
    computed: float
    reference: float
    within: float

    def ratio(self):
        return self.computed / self.reference if self.reference else float(self.computed == 0)

    def is_good(self):
        return abs(self.ratio() - 1) <= self.within


def harmonic_rows(folder, case):
    exact = beam.full_response(case, beam.HIGHEST)
    for entry in beam.REFERENCE[case.name]["harmonic"]:
        n, ratio = entry["n_h"], entry["frm_at"]
        is_complete = n not in beam.SIZES
        name = "all" if is_complete else beam.body_name(n, ratio)
        response = beam.body_response(beam.body_file(folder, case, name), case, beam.HIGHEST)
        for quantity, error in zip("wMQ", response.errors(exact)):
            if is_complete and quantity == "w":
                continue  # 3e-8 of the response: round-off
            yield Row(f"{case.name}: {name}, error of {quantity}", error, entry[quantity], ROUND_OFF)


def figures(folder):
    for case in beam.CASES:
        reference = beam.REFERENCE[case.name]
        with h5py.File(beam.body_file(folder, case, "all")) as body:
            condition = body["preparation/condition_Q_dd"][()]
        errors = frequency_errors(folder, case)
        below = int(np.sum(np.abs(errors) < 0.01))
        yield Row(f"{case.name}: constrained modes", len(errors), len(reference["omega"]), 0)
        yield Row(f"{case.name}: of these below 1 %", below, reference["modes_below_1_percent"], 0)
        for mode in (50, 90, 104):
            error = reference["frequency_errors"][mode - 1]
            yield Row(f"{case.name}: error of frequency {mode}", errors[mode - 1], error, ROUND_OFF)
        yield Row(f"{case.name}: condition of Q_dd", condition, reference["condition_Q_dd"], 1e-8)
        yield from harmonic_rows(folder, case)


@dataclass(frozen=True)
class Selection:
    """What a tolerance chose, that was the error of five modes and one interface mode."""

    name: str
    tolerance: float
    error: float
    size: int

    def is_good(self):
        return self.size <= 6 and self.error <= self.tolerance


def selections(folder):
    for case in beam.CASES:
        with h5py.File(beam.body_file(folder, case, "selected")) as body:
            error = body["selection/with_interface_modes/error"][-1]
            yield Selection(case.name, body["selection/tolerance"][()], error,
                            len(body["modes/frequencies"]))  # fmt: skip


def print_table(rows):
    width = max(len(row.name) for row in rows)
    print(f"{'figure':{width}} {'computed':>13} {'reference':>13}  ratio")
    for row in rows:
        print(f"{row.name:{width}} {row.computed:13.7g} {row.reference:13.7g} {row.ratio():9.6f}")


def print_selections(all_selections):
    for selection in all_selections:
        print(
            f"{selection.name}: for the accuracy of 5 modes and one FRM ({selection.tolerance:.2e}) the "
            f"program chose a body of {selection.size} modes with {selection.error:.2e}"
        )


if __name__ == "__main__":
    out = Path(sys.argv[1])
    print_table(list(figures(out)))
    print()
    print_selections(list(selections(out)))
