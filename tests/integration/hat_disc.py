"""A disc with hat and cooling holes: the same frequencies on any number of ranks, files without fault.

Usage: hat_disc.py PROGRAM_DIR MPIRUN
"""

import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "examples/hat_disc"))
import report  # noqa: E402  (beside the scene, not a package)
from checked import failed_checks  # noqa: E402

SCENE = ROOT / "tests/data/coarse_hat_disc.toml"
# K and M are equal to the last bit; factorisations and reductions add in another order.
TOLERANCE = 1e-9


def run(programs, mpirun, ranks, scene, output):
    subprocess.run(
        [mpirun, "--oversubscribe", "-n", str(ranks), programs / "chladni", "run", scene, "--output", output],
        check=True,
        stdout=subprocess.DEVNULL,
    )


def main(programs, mpirun):
    with tempfile.TemporaryDirectory() as folder:
        folders = {ranks: Path(folder) / f"{ranks} ranks" for ranks in (1, 2, 4)}
        for ranks, output in folders.items():
            run(programs, mpirun, ranks, SCENE, output)
        runs = [report.frequencies(output) for output in folders.values()]
        run(programs, mpirun, 2, ROOT / "examples/hat_disc/scene.toml", Path(folder) / "example")
        unsound = list(failed_checks(programs, folder))
    report.print_table([f"{ranks} ranks" for ranks in folders], runs)
    if not report.largest_difference(runs) < TOLERANCE:
        sys.exit(f"FAILED: more than {TOLERANCE}")
    if unsound:
        sys.exit("FAILED: " + "; ".join(unsound))


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
