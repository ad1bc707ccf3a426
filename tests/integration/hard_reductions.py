"""Reductions that are hard, and refusals on several ranks: no hang, one message, the old file untouched.

Usage: hard_reductions.py PROGRAM_DIR MPIRUN
"""

import json
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

from running import changed, start

SCENE = (Path(__file__).parents[1] / "data/coarse_disc.toml").read_text()

TWO_PLATES = """
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 0.2, 0.1};
Rectangle(2) = {0.3, 0, 0, 0.2, 0.1};
Physical Surface("disc") = {1, 2};
Physical Curve("edge") = {4};
Mesh.MeshSizeMax = 0.05;
"""


def two_plates():
    annulus = SCENE[SCENE.index('generator = "annulus"') : SCENE.index("[material.iron]")]
    return changed(SCENE, (annulus, 'file = "two.geo"\nelement_order = 2\n'),
                   ('group = "inner_edge"', 'group = "edge"'), ('["track", "hub"]', '["hub"]'))  # fmt: skip


class Programs:
    def __init__(self, programs, mpirun):
        self.chladni, self.mpirun = programs / "chladni", mpirun

    def command(self, folder, options=()):
        return [self.chladni, "reduce", folder / "scene.toml", "--output", folder / "out",
                "--json", folder / "summary.json", "--", *options]  # fmt: skip

    def run(self, scene, ranks=1, options=(), folder=None):
        """What it printed, its summary, and a dictionary of the certificate."""
        with tempfile.TemporaryDirectory() as name:
            folder = Path(folder or name)
            (folder / "scene.toml").write_text(scene)
            (folder / "two.geo").write_text(TWO_PLATES)
            run = start(*self.command(folder, options), mpirun=self.mpirun, ranks=ranks, cwd=folder, timeout=100)
            if run.returncode != 0:
                return run, None, None
            with h5py.File(next((folder / "out").glob("*.reduced.h5"))) as file:
                group = file["certificate"]
                certificate = {name: group[name][()] for name in
                               ("frequencies", "eta2", "rigid_modes", "rigid_residual")}  # fmt: skip
            return run, json.loads((folder / "summary.json").read_text()), certificate


def hard_cases(programs):
    thin = ("thickness = 0.02", "thickness = 0.0016")
    hub_only = changed(SCENE, ('["track", "hub"]', '["hub"]'), thin)
    run, summary, certificate = programs.run(hub_only)
    yield "one attachment node on a thin disc", run, summary and (
        summary["n_masters"] == 6 and certificate["rigid_modes"] == 6
        # All modes with the hub held are fixed-interface modes: exact.
        and certificate["eta2"].max() < 1e-9)  # fmt: skip

    bending = []
    for thickness in ("1.62e-4", "1.62e-5"):
        run, summary, certificate = programs.run(
            changed(SCENE, ("thickness = 0.02", f"thickness = {thickness}"),
                    ("modes = 20", "modes = 40")))  # fmt: skip
        yield f"thickness {thickness}", run, summary and certificate["rigid_modes"] == 6
        bending.append(certificate["frequencies"][:3] / float(thickness))
    # Thin plates vibrate in proportion to their thickness; shear is the square of h / r more.
    difference = np.max(np.abs(bending[0] / bending[1] - 1))
    yield f"r/h = 1e4 is in proportion, {difference:.0e}", None, difference < 1e-3

    run, summary, certificate = programs.run(
        changed(SCENE, ("nodes = 12", "nodes = 168"), ("modes = 20", "modes = 10")))  # fmt: skip
    yield "a thousand masters", run, summary and (
        summary["n_masters"] == 1014 and certificate["rigid_modes"] == 6
        and certificate["eta2"][0] < 1e-3)  # fmt: skip

    run, summary, certificate = programs.run(changed(SCENE, ('fixed = ["hub"]', "fixed = []")))
    yield "six zero modes of the free disc", run, summary and (
        certificate["rigid_modes"] == 6 and certificate["rigid_residual"] < 1e-9)  # fmt: skip

    by_tolerance = changed(SCENE, ("modes = 20", "tolerance = 1e-3\nup_to_Hz = 6000.0"))
    found = []
    for ranks in (1, 2, 4):
        run, summary, certificate = programs.run(by_tolerance, ranks)
        yield f"tolerance on {ranks} ranks", run, summary and certificate["eta2"].max() / 2 < 1e-3
        found.append((summary["n_modes"], certificate["frequencies"]))
    same = max(np.max(np.abs(f / found[0][1] - 1)) for _, f in found)
    yield f"equal on 1, 2 and 4 ranks, {same:.0e}", None, (
        len({n for n, _ in found}) == 1 and same < 1e-9)  # fmt: skip
    fewer = changed(SCENE, ("modes = 20", f"modes = {int(0.95 * found[0][0])}"))
    run, summary, certificate = programs.run(fewer)
    in_range = certificate["frequencies"] * (1 - certificate["eta2"] / 2) < 2 * np.pi * 6000
    yield "fewer modes do not keep the tolerance", run, certificate["eta2"][in_range].max() / 2 > 1e-3


def refusals(programs):
    cases = [
        ("two plates of which one has no master", two_plates(), (),
         ["not positive definite", "moves most at node"]),
        ("more modes than exist", changed(SCENE, ("modes = 20", "modes = 1000000")), (),
         ["1000000 modes", "slaves"]),
        ("more memory than allowed", SCENE, ("-cms_memory", "1"), ["MiB", "-cms_memory"]),
        ("no such solver", SCENE, ("-cms_modes_solver", "lapack"), ["lapack", "block-lanczos"]),
        ("tolerance of a free-interface method",
         changed(SCENE, ('"craig-bampton"', '"rubin"'),
                 ("modes = 20", "tolerance = 1e-3\nup_to_Hz = 6000.0")), (), ["craig-bampton"]),
    ]  # fmt: skip
    for name, scene, options, words in cases:
        for ranks in (1, 2):
            with tempfile.TemporaryDirectory() as folder:
                out = Path(folder) / "out"
                out.mkdir()
                (out / "disc.reduced.h5").write_text("old")
                (out / "scene.reduced.h5").write_text("old")
                run, _, _ = programs.run(scene, ranks, options, folder)
                untouched = {file.name for file in out.iterdir()} == {
                    "disc.reduced.h5", "scene.reduced.h5"} and all(
                    file.read_text() == "old" for file in out.iterdir())  # fmt: skip
            yield f"{name}, {ranks} ranks", run, run.returncode != 0 and untouched and all(
                word in run.stderr for word in words)  # fmt: skip


def interruption(programs):
    """Killed at any time, a run leaves the old file or a whole new one."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "scene.toml").write_text(SCENE)
        for after_s in (0.05, 0.3, 0.6, 1.0):
            process = subprocess.Popen(programs.command(folder), stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)  # fmt: skip
            time.sleep(after_s)
            process.send_signal(signal.SIGKILL)
            process.wait()
            for path in (folder / "out").glob("*.reduced.h5"):
                with h5py.File(path) as file:
                    assert np.isfinite(file["matrices/stiffness"][()]).all()
    yield "killed runs leave no half file", None, True


def main(programs):
    good = True
    for part in (hard_cases, refusals, interruption):
        for name, run, holds in part(programs):
            good = good and bool(holds)
            print(f"{'ok' if holds else 'FAILED':8}{name}", flush=True)
            if not holds and run is not None:
                print(run.stdout[-1500:], run.stderr)
    return good


if __name__ == "__main__":
    sys.exit(not main(Programs(Path(sys.argv[1]), sys.argv[2])))
