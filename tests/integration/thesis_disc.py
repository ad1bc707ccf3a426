"""The thesis disc from the mesh to the squeal, against its references.

Usage: thesis_disc.py PROGRAM_DIR
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

EXAMPLE = Path(__file__).parents[2] / "examples/thesis_disc"
sys.path.insert(0, str(EXAMPLE))
import report  # noqa: E402  (beside the scene, not a package)


def run(programs, folder):
    for program in ("chladni", "squeal"):
        subprocess.run(
            [programs / program, "run", EXAMPLE / "scene.toml", "--output", folder,
             "--json", folder / f"{program}.json"],
            check=True,
        )  # fmt: skip


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


def main(programs):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run(programs, folder)
        rows = report.figures(*report.read(folder))
        ratio = rigid_body_ratio(folder)
    report.print_table(rows)
    print(f"six rigid-body frequencies, below {ratio:.1e} of the first elastic one")
    bad = [row.name for row in rows if row.within and not abs(row.ratio() - 1) < row.within]
    if not ratio < 1e-3:
        bad.append("rigid-body frequencies")
    if bad:
        sys.exit(f"FAILED: {', '.join(bad)}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
