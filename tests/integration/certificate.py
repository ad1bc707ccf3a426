"""What the certificate of a coarse disc claims, against a reduction that is much finer and against the FE model itself; and
`chladni compare`.

Usage: certificate.py PROGRAM_DIR
"""

import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import h5py
import numpy as np

from running import changed, run, summary

SCENE = (Path(__file__).parents[1] / "data/coarse_disc.toml").read_text()


def certificate(programs, modes):
    """The group of the file, and what `chladni info` says of it."""
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.toml"
        scene.write_text(changed(SCENE, ("modes = 20\n", f"modes = {modes}\nsylvester = true\n")))
        run(programs / "chladni", "reduce", scene, "--output", folder)
        file = next(Path(folder).glob("*.reduced.h5"))
        info = run(programs / "chladni", "info", file)
        with h5py.File(file) as reduced:
            group = reduced["certificate"]
            names = ("frequencies", "eta2", "bounds", "rigid_modes", "counts/up_to",
                     "counts/expected", "counts/found")  # fmt: skip
            return {name: group[name][()] for name in names}, info


def frequencies(programs, command, folder):
    """Elastic ones in Hz, of the body or of the FE model."""
    made = summary(programs / "chladni", command, folder / "scene.toml", "--output", folder)
    found = np.array(made["frequencies_Hz"])
    return found[found > 0.0]


def held_directly(programs, fixed, support):
    """The modes of the body under a support are those of the FE model under it, within eta."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        text = changed(SCENE, ('fixed = ["hub"]', f"fixed = {fixed}"), ("modes = 20\n", "modes = 60\n"))
        (folder / "scene.toml").write_text(text + support + "[modes]\ncount = 20\n")
        body, full = frequencies(programs, "run", folder), frequencies(programs, "modes", folder)
        with h5py.File(next(folder.glob("*.body.h5"))) as file:
            same_support = list(file["certificate/fixed"].asstr()) == list(file["fixed"].asstr())
            certified = file["certificate/frequencies"][:] / (2 * np.pi)
            eta2 = file["certificate/eta2"][:]
    n = min(12, len(full), len(certified))
    error = (body[:n] / full[:n]) ** 2 - 1
    print(fixed, "\nerrors", error, "\neta^2 ", eta2[:n])
    yield f"{fixed}: the body has the certificate of its support", same_support
    yield f"{fixed}: and its frequencies", np.allclose(certified[:n], body[:n], rtol=1e-6)
    yield f"{fixed}: {n} modes within eta of the FE model", bool(np.all(np.abs(error) <= np.sqrt(eta2[:n])))
    # Both eigen-solvers leave some 1e-9 of lambda; higher up eta^2 is an estimate, not a bound.
    yield f"{fixed}: and about eta^2 above it", bool(np.all(np.abs(error - eta2[:n]) <= 0.3 * eta2[:n] + 1e-8))


def partner_is_said(programs):
    """The fortieth mode of the held ring has a partner, which is kept too."""
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.toml"
        scene.write_text(changed(SCENE, ("modes = 20\n", "modes = 40\n")))
        printed = run(programs / "chladni", "reduce", scene, "--output", folder)
    return "41 (40 asked; 1 more of the same frequency)" in printed


def uncertified_is_said(programs):
    """Modes that are kept beyond the range of the certificate, and within it."""
    said = []
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.toml"
        for kept in ("up_to_Hz = 2000.0", "up_to_Hz = 16000.0"):
            scene.write_text(changed(SCENE, ("keep = { modes = 30 }", f"keep = {{ {kept} }}")))
            said.append("error estimates of the reduction end" in run(programs / "chladni", "run", scene, "--output", folder))
    return said == [False, True]


def comparison(programs):
    """`chladni compare`: the FE model's own frequencies; what each method can; and one that cannot stops no other."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        support = '[[support]]\ngroup = "hub"\ntype = "clamped"\n[modes]\ncount = 12\n'
        (folder / "scene.toml").write_text(SCENE + support)
        full = frequencies(programs, "modes", folder)
        words = ("scene.toml", "--output", folder, "--modes", "12,60,900000", "--frequencies", "12")
        found = summary(programs / "chladni", "compare", folder / words[0], *words[1:])
        rows = {(row["method"], row["asked"]): row for row in found["reductions"]}
        picture = ElementTree.parse(next(folder.glob("*.compare.svg")))
    yield "compare has the frequencies of the FE model", bool(np.all(np.abs(np.array(found["frequencies_Hz"]) / full - 1) < 1e-9))
    own = rows["mixed-interface", "12 modes"]
    yield "modes of the supported body itself are exact", own["error"] < 1e-9 and own["is_best_in_size"]
    for method, few, many in (("craig-bampton", 0.1, 2e-3), ("rubin", 2e-2, 1e-4)):
        errors = [rows[method, f"{n} modes"]["error"] for n in (12, 60)]
        yield f"{method} by 12 and 60 modes: {errors}", errors[0] > 10 * errors[1] and errors[0] < few and errors[1] < many
    for asked in (1e-2, 1e-3, 1e-4):
        row = rows["craig-bampton", f"tolerance {asked:g}"]
        yield f"tolerance {asked:g}: {row['error']:.1e}, estimated {row['estimated_error']:.1e}", row["error"] < 1.1 * asked and 0.5 < row["estimated_error"] / row["error"] < 2
    refused = [row for row in found["reductions"] if row["refusal"]]
    yield "900000 modes are refused before any is sought, by each method", (
        len(refused) == 3 and "slaves" in refused[0]["refusal"] and all("at most" in row["refusal"] for row in refused[1:]))
    circles = [element for element in picture.iter() if element.tag.endswith("circle")]
    yield f"{len(circles)} points in the picture", len(circles) == 2 * (len(rows) - 3) + 5


SUPPORTS = (
    ('["hub"]', '[[support]]\ngroup = "hub"\ntype = "clamped"\n'),
    ('["hub.x", "hub.y", "hub.z"]', '[[support]]\ngroup = "hub"\ntype = "simply-supported"\n'),
    ('["track.z"]', '[[support]]\ngroup = "track"\ndofs = ["z"]\n'),
)


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
    checks["a partner beyond the number asked for is said"] = partner_is_said(programs)
    checks["modes kept beyond the certified range are said"] = uncertified_is_said(programs)
    checks.update(comparison(programs))
    for fixed, support in SUPPORTS:
        checks.update(held_directly(programs, fixed, support))
    for claim, holds in checks.items():
        print(f"{'ok' if holds else 'FAILED':8}{claim}")
    return all(checks.values())


if __name__ == "__main__":
    sys.exit(not main(Path(sys.argv[1])))
