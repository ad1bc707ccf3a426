"""The beam example: reduction, all bodies, checks, and every number against its reference.

Usage: beam.py PROGRAM_DIR
"""

import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "examples/beam"))
import beam  # noqa: E402  (beside the scenes, not a package)
import report  # noqa: E402
import study  # noqa: E402
from checked import failed_checks  # noqa: E402


def main(programs):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        study.main(programs, folder)
        bad = list(failed_checks(programs, folder))
        rows = list(report.figures(folder))
        selections = list(report.selections(folder))
    report.print_table(rows)
    report.print_selections(selections)
    bad += [row.name for row in rows if not row.is_good()]
    bad += [f"selection: {selection.name}" for selection in selections if not selection.is_good()]
    if bad:
        sys.exit(f"FAILED: {', '.join(bad)}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
