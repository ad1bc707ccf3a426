"""Modes of the body under its own support: frequencies of the FE model, on any number of ranks, and the choice by cost.

Usage: mixed_interface.py PROGRAM_DIR MPIRUN
"""

import json
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

from checked import failed_checks
from running import changed, start

SCENE = (Path(__file__).parents[1] / "data/coarse_disc.toml").read_text()
RANGE_HZ = 6000.0
MODES = SCENE + '\n[[support]]\ngroup = "hub"\ntype = "clamped"\n[modes]\ncount = 40\n'
AUTO = changed(SCENE, ('method = "craig-bampton"\n', ""), ("modes = 20", f"tolerance = 1e-4\nup_to_Hz = {RANGE_HZ}"))


class Programs:
    def __init__(self, programs, mpirun):
        self.folder_of_programs, self.mpirun = programs, mpirun

    def run(self, command, scene, folder, ranks=1):
        """Its summary, and what the file holds of the certificate."""
        folder.mkdir(exist_ok=True)
        (folder / "scene.toml").write_text(scene)
        run = start(self.folder_of_programs / "chladni", command, folder / "scene.toml", "--output", folder / "out",
                    "--json", folder / "summary.json", mpirun=self.mpirun, ranks=ranks, timeout=100)  # fmt: skip
        if run.returncode != 0:
            raise SystemExit(f"{command}: {run.stderr}")
        return json.loads((folder / "summary.json").read_text())


def reduced(folder):
    """Matrices, frequencies and bounds of the reduced file."""
    with h5py.File(next((folder / "out").glob("*.reduced.h5"))) as file:
        certificate = file["certificate"]
        return {"K": file["matrices/stiffness"][()], "M": file["matrices/mass"][()],
                "f": certificate["frequencies"][()] / (2 * np.pi), "eta2": certificate["eta2"][()]}  # fmt: skip


def held_response(file, Omega):
    """Undamped response of the ring, normal to the disc, to unit loads there, with the hub held."""
    masters = list(zip(file["masters/node"][:], file["masters/component"][:]))
    ring, hub = (set(file[f"attachment/sets/{name}"][:]) for name in ("track", "hub"))
    K, M = file["matrices/stiffness"][:], file["matrices/mass"][:]
    free = [i for i in range(len(K)) if i >= len(masters) or masters[i][0] not in hub]
    loads = [row for row, i in enumerate(free) if i < len(masters) and masters[i][0] in ring and masters[i][1] == 2]
    A = K[np.ix_(free, free)] - Omega**2 * M[np.ix_(free, free)]
    return np.linalg.solve(A, np.eye(len(free))[:, loads])[loads]


def response_error(programs, folder, scene):
    """At the end of the range, against the FE model's own responses there, of which `space = "full"` makes modes."""
    Omega = 2 * np.pi * RANGE_HZ
    full = changed(scene, (f"tolerance = 1e-4\nup_to_Hz = {RANGE_HZ}", 'method = "craig-bampton"\nmodes = 20'),
                   (f"keep = {{ tolerance = 1e-3, up_to_Hz = {RANGE_HZ} }}",
                    f'interface_modes = [{{ kind = "frm", at = "track", dofs = ["z"], omega0 = {Omega}, space = "full" }}]'))
    programs.run("reduce", full, folder / "full")
    found, exact = (held_response(h5py.File(next((folder / name / "out").glob("*.reduced.h5"))), Omega) for name in ("kept1", "full"))
    return np.max(np.linalg.norm(found - exact, axis=0) / np.linalg.norm(exact, axis=0))


def checks(programs, folder):
    full = np.array(programs.run("modes", MODES, folder / "modes")["frequencies_Hz"])
    full = full[full <= RANGE_HZ]
    models = {}
    for ranks in (1, 2):
        where = folder / f"auto{ranks}"
        summary = programs.run("run" if ranks == 1 else "reduce", AUTO, where, ranks)
        models[ranks] = reduced(where)
        f = models[ranks]["f"]
        yield f"auto on {ranks} ranks takes the mixed interface", (
            summary["method"] == "mixed-interface" and "masters are free" in summary["why_this_method"])  # fmt: skip
        yield f"{len(f)} of {len(full)} modes of the range, no more are kept", (
            len(f) == len(full) == summary["n_modes"])  # fmt: skip
        worst = np.max(np.abs(f / full - 1))
        yield f"they are those of the FE model, {worst:.0e}", worst < 1e-9
    a, b = models[1], models[2]
    n = len(a["K"]) - len(full)
    worst = max(np.max(np.abs(a[x][:n, :n] - b[x][:n, :n])) / np.max(np.abs(a[x])) for x in "KM")
    yield f"static condensation and its mass on 1 and 2 ranks, {worst:.0e}", worst < 1e-9
    for line in failed_checks(programs.folder_of_programs, folder / "auto1"):
        yield line, False

    kept = changed(AUTO, ("keep = { modes = 30 }", f"keep = {{ tolerance = 1e-3, up_to_Hz = {RANGE_HZ} }}"))
    selections = []
    for ranks in (1, 2):
        selection = programs.run("run", kept, folder / f"kept{ranks}", ranks)["selection"]
        of_body = min(selection[path][-1]["error"] for path in ("modes_only", "with_interface_modes"))
        total = of_body + selection["error_of_reduction"]
        yield f"responses within {total:.1e} of the FE model's on {ranks} ranks", total <= 1e-3
        selections.append(selection["error_of_reduction"])
    yield f"bounds on 1 and 2 ranks: {selections}", abs(selections[0] / selections[1] - 1) < 1e-3
    bound, error = selections[0], response_error(programs, folder, kept)
    yield f"the reduction's error {error:.1e} is below its bound {bound:.1e}, and near it", 0.05 * bound < error <= bound
    for line in failed_checks(programs.folder_of_programs, folder / "kept1"):
        yield line, False

    all_held = changed(AUTO, ('["track", "hub"]', '["hub"]'))
    summary = programs.run("reduce", all_held, folder / "held")
    yield "with all masters held it is Craig and Bampton's", (
        summary["method"] == "craig-bampton" and "holds all masters" in summary["why_this_method"])  # fmt: skip

    # The same modes, and the support taken away: estimates, as of any other method.
    by_number = changed(SCENE, ("craig-bampton", "mixed-interface"), ("modes = 20", f"modes = {len(full)}"))
    programs.run("reduce", by_number, folder / "number")
    worst = np.max(np.abs(reduced(folder / "number")["f"][: len(full)] / full - 1))
    yield f"by their number, {worst:.0e}", worst < 1e-9
    programs.run("reduce", changed(by_number, ('fixed = ["hub"]', "fixed = []")), folder / "free")
    free = changed(MODES, ('[[support]]\ngroup = "hub"\ntype = "clamped"\n', ""))
    exact = np.array(programs.run("modes", free, folder / "free_modes")["frequencies_Hz"])
    exact = exact[exact > 1.0]
    f = reduced(folder / "free")["f"]
    worst = np.max(np.abs(f / exact[: len(f)] - 1))
    yield f"{len(f)} modes of the free disc where nothing is held, {worst:.0e}", len(f) >= len(full) and worst < 1e-9


def main():
    programs = Programs(Path(sys.argv[1]), sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:
        results = list(checks(programs, Path(folder)))
    for name, passed in results:
        print(f"{'ok  ' if passed else 'FAIL'} {name}")
    return 0 if all(passed for _, passed in results) else 1


if __name__ == "__main__":
    sys.exit(main())
