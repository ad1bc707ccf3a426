"""What the certificate of a coarse disc claims, against a reduction that is much finer.

Usage: certificate.py PROGRAM_DIR
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

SCENE = (Path(__file__).parents[1] / "data/coarse_disc.toml").read_text()


def certificate(programs, modes):
    """The group of the file, and what `chladni info` says of it."""
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.toml"
        assert SCENE.count("modes = 20\n") == 1
        scene.write_text(SCENE.replace("modes = 20\n", f"modes = {modes}\nsylvester = true\n"))
        subprocess.run([programs / "chladni", "reduce", scene, "--output", folder],
                       check=True, stdout=subprocess.DEVNULL)  # fmt: skip
        file = next(Path(folder).glob("*.reduced.h5"))
        info = subprocess.run([programs / "chladni", "info", file],
                              check=True, capture_output=True, text=True)  # fmt: skip
        with h5py.File(file) as reduced:
            group = reduced["certificate"]
            names = ("frequencies", "eta2", "bounds", "rigid_modes", "counts/up_to",
                     "counts/expected", "counts/found")  # fmt: skip
            return {name: group[name][()] for name in names}, info.stdout


def main(programs):
    coarse, info = certificate(programs, 20)
    fine, _ = certificate(programs, 200)
    checks = {"six rigid motions": coarse["rigid_modes"] == 6}
    expected, found = coarse["counts/expected"], coarse["counts/found"]
    checks["all fixed-interface modes are there"] = expected[0] == found[0] >= 20
    checks["none is missing where it says so"] = expected[2] == found[2] > 0
    for i in (1, 2):
        # The finer model has all of these, since its own count is complete far above.
        below = np.count_nonzero(fine["frequencies"] < coarse["counts/up_to"][i])
        checks[f"{expected[i]} expected are {below} of the finer model"] = expected[i] == below
    missing = expected[1] - found[1]
    checks[f"info: {missing} missing"] = f"found, {missing} missing" in info
    # The finer model is still above the mesh: the true errors are larger than these.
    n = len(coarse["bounds"])
    errors = (coarse["frequencies"][:n] / fine["frequencies"][:n]) ** 2 - 1
    checks[f"{n} bounds hold"] = n > 0 and bool(np.all(coarse["bounds"] >= errors))
    print("errors", errors, "\nbounds", coarse["bounds"])
    for claim, holds in checks.items():
        print(f"{'ok' if holds else 'FAILED':8}{claim}")
    return all(checks.values())


if __name__ == "__main__":
    sys.exit(not main(Path(sys.argv[1])))
