"""A disc with hat and cooling holes has the same frequencies on any number of ranks.

Usage: hat_disc.py PROGRAM_DIR MPIRUN
"""

import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "examples/hat_disc"))
import report  # noqa: E402  (beside the scene, not a package)

SCENE = ROOT / "tests/data/coarse_hat_disc.toml"
# K and M are equal to the last bit; factorisations and reductions add in another order.
TOLERANCE = 1e-9


def main(programs, mpirun):
    with tempfile.TemporaryDirectory() as folder:
        folders = {ranks: Path(folder) / f"{ranks} ranks" for ranks in (1, 2, 4)}
        for ranks, output in folders.items():
            subprocess.run(
                [mpirun, "--oversubscribe", "-n", str(ranks), programs / "chladni", "run", SCENE,
                 "--output", output],
                check=True,
                stdout=subprocess.DEVNULL,
            )  # fmt: skip
        runs = [report.frequencies(output) for output in folders.values()]
    report.print_table([f"{ranks} ranks" for ranks in folders], runs)
    if not report.largest_difference(runs) < TOLERANCE:
        sys.exit(f"FAILED: more than {TOLERANCE}")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
