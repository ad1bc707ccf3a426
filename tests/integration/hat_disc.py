"""A disc with hat and cooling holes: the same frequencies on any number of ranks, files without fault.

Usage: hat_disc.py PROGRAM_DIR MPIRUN
"""

import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "examples/hat_disc"))
import report  # noqa: E402  (beside the scene, not a package)
from checked import failed_checks  # noqa: E402
from running import run  # noqa: E402

SCENE = ROOT / "tests/data/coarse_hat_disc.toml"
# K and M are equal to the last bit; factorisations and reductions add in another order.
TOLERANCE = 1e-9


def main(programs, mpirun):
    def make(ranks, scene, output):
        run(programs / "chladni", "run", scene, "--output", output, mpirun=mpirun, ranks=ranks)

    with tempfile.TemporaryDirectory() as folder:
        folders = {ranks: Path(folder) / f"{ranks} ranks" for ranks in (1, 3)}
        for ranks, output in folders.items():
            make(ranks, SCENE, output)
        runs = [report.frequencies(output) for output in folders.values()]
        make(1, ROOT / "examples/hat_disc/scene.toml", Path(folder) / "example")
        unsound = list(failed_checks(programs, folder))
    report.print_table([f"{ranks} ranks" for ranks in folders], runs)
    if not report.largest_difference(runs) < TOLERANCE:
        sys.exit(f"FAILED: more than {TOLERANCE}")
    if unsound:
        sys.exit("FAILED: " + "; ".join(unsound))


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
