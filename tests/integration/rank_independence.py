"""The body's frequencies do not depend on the number of ranks.

Usage: rank_independence.py PROGRAM_DIR MPIRUN
"""

import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

from running import run

SCENE = Path(__file__).parents[1] / "data/coarse_disc.toml"
# K and M are equal to the last bit; factorisations and reductions add in another order, which
# the frequencies feel as round-off times the condition of K_ss.
TOLERANCE = 1e-9


def frequencies(programs, mpirun, ranks):
    with tempfile.TemporaryDirectory() as folder:
        run(programs / "chladni", "run", SCENE, "--output", folder, mpirun=mpirun, ranks=ranks)
        with h5py.File(next(Path(folder).glob("*.body.h5"))) as body:
            return body["modes/frequencies"][:]


def main(programs, mpirun):
    one = frequencies(programs, mpirun, 1)
    for ranks in (2, 3):
        difference = np.max(np.abs(frequencies(programs, mpirun, ranks) / one - 1))
        print(f"{ranks} ranks: {one.size} frequencies, largest relative difference {difference:.1e}")
        if not difference < TOLERANCE:
            sys.exit(f"FAILED: more than {TOLERANCE}")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
