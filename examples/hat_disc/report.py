"""Compares the frequencies of runs of one disc. Usage: report.py OUTPUT_DIR [OUTPUT_DIR...]

Each folder holds the *.body.h5 of a run; the first is the reference of the others. Runs on other
numbers of ranks must agree to round-off.
"""

import sys
from pathlib import Path

import h5py
import numpy as np


def frequencies(folder):
    """Of the held body, Hz."""
    with h5py.File(next(Path(folder).glob("*.body.h5"))) as body:
        return body["modes/frequencies"][:] / (2 * np.pi)


def largest_difference(runs):
    """Relative, of any run from the first."""
    return max((np.max(np.abs(run / runs[0] - 1)) for run in runs[1:]), default=0.0)


def print_table(names, runs, rows=12):
    width = max(14, *(len(name) + 2 for name in names))
    print("mode" + "".join(f"{name:>{width}}" for name in names))
    for mode, row in enumerate(zip(*runs), start=1):
        if mode <= rows:
            print(f"{mode:4}" + "".join(f"{f:{width}.7g}" for f in row))
    if len(runs) > 1:
        print(f"largest relative difference of {len(runs[0])} modes: {largest_difference(runs):.1e}")


if __name__ == "__main__":
    print_table(sys.argv[1:], [frequencies(folder) for folder in sys.argv[1:]])
