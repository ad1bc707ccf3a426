"""The thesis disc from the mesh to the squeal, against its references.

Usage: thesis_disc.py PROGRAM_DIR
"""

import shutil
import sys
import tempfile
from math import pi
from pathlib import Path

import h5py

EXAMPLE = Path(__file__).parents[2] / "examples/thesis_disc"
sys.path.insert(0, str(EXAMPLE))
import report  # noqa: E402  (beside the scene, not a package)
from checked import failed_checks  # noqa: E402
from running import run, summary  # noqa: E402


def make(programs, folder):
    for program in ("chladni", "squeal"):
        run(programs / program, "run", EXAMPLE / "scene.toml", "--output", folder, "--json", folder / f"{program}.json")


def critical_speed_without_coriolis(programs, folder):
    """In pi rad/s, of the same body without its mass integrals: Coriolis forces are then left out."""
    scene = (EXAMPLE / "scene.toml").read_text().splitlines()
    lines = ['analyses = ["critical-speed"]' if line.startswith("analyses = ") else line for line in scene]
    (folder / "critical.toml").write_text("\n".join(lines) + "\n")
    body = folder / "without.body.h5"
    shutil.copy(next(folder.glob("*.body.h5")), body)
    with h5py.File(body, "a") as file:
        del file["mass_integrals"]
    run(programs / "squeal", "seal", body)
    (folder / "without").mkdir()
    found = summary(programs / "squeal", "run", folder / "critical.toml", "--body", body, "--output", folder / "without")
    return found["critical_speed_rad_s"] / pi


def compare_mechanisms(programs, folder):
    """Runs ../mechanisms on the body of the disc; whether it wrote what it found."""
    script = EXAMPLE.parent / "mechanisms/on_the_disc.py"
    body = next(folder.glob("*.body.h5"))
    out = folder / "mechanisms"
    out.mkdir()
    run(sys.executable, script, programs / "squeal", body, out, out)
    return (out / "mechanisms_on_the_disc.json").exists()


def main(programs):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        make(programs, folder)
        rows = report.figures(*report.read(folder))
        ratio = report.rigid_body_ratio(folder)
        unsound = list(failed_checks(programs, folder))
        compared = compare_mechanisms(programs, folder)
        without = critical_speed_without_coriolis(programs, folder)
    # That of the reference; the frequency of the mesh is 3e-5 above it.
    rows.append(report.Figure("the same without Coriolis forces", "pi rad/s", without, 4.235183, report.TWO_MODES, 5e-4))
    report.print_table(rows)
    report.print_rigid_body_ratio(ratio)
    bad = unsound + [row.name for row in rows if row.within and not abs(row.ratio() - 1) < row.within]
    if not compared:
        bad.append("examples/mechanisms/on_the_disc.py")
    if not ratio < 1e-3:
        bad.append("rigid-body frequencies")
    if bad:
        sys.exit(f"FAILED: {', '.join(bad)}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
