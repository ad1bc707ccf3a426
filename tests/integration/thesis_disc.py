"""The thesis disc from the mesh to the squeal, against its references.

Usage: thesis_disc.py PROGRAM_DIR
"""

import subprocess
import sys
import tempfile
from pathlib import Path

EXAMPLE = Path(__file__).parents[2] / "examples/thesis_disc"
sys.path.insert(0, str(EXAMPLE))
import report  # noqa: E402  (beside the scene, not a package)
from checked import failed_checks  # noqa: E402


def run(programs, folder):
    for program in ("chladni", "squeal"):
        subprocess.run(
            [programs / program, "run", EXAMPLE / "scene.toml", "--output", folder,
             "--json", folder / f"{program}.json"],
            check=True,
        )  # fmt: skip


def main(programs):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run(programs, folder)
        rows = report.figures(*report.read(folder))
        ratio = report.rigid_body_ratio(folder)
        unsound = list(failed_checks(programs, folder))
    report.print_table(rows)
    report.print_rigid_body_ratio(ratio)
    bad = unsound + [row.name for row in rows if row.within and not abs(row.ratio() - 1) < row.within]
    if not ratio < 1e-3:
        bad.append("rigid-body frequencies")
    if bad:
        sys.exit(f"FAILED: {', '.join(bad)}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
