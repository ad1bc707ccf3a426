"""A ring whose harmonics are masters: the same disc, with a certificate that is as good, from reduction to squeal.

Usage: ring_harmonics.py PROGRAM_DIR MPIRUN
"""

import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

from running import changed, run, start, summary

from checked import failed_checks

NODES = 'nodes = ["track", "hub"]\n'
SQUEAL = """
[squeal]
ring = "track"
thickness = 0.02
use_modes = "nodal-diameters 3"
speeds = { from_rad_s = 3.0, to_rad_s = 60.0, count = 5 }
friction = 0.6
contact = "bilateral"
pads = [{ angle_deg = 0.0, stiffness = 6e6, damping = 0.0, preload = 2000.0 }]
analyses = ["eigenvalues", "critical-speed"]
"""
SCENE = (Path(__file__).parents[1] / "data/coarse_disc.toml").read_text() + SQUEAL
CLAMPED = '[[support]]\ngroup = "hub"\ntype = "clamped"\n[modes]\ncount = 30\n'


def with_rings(harmonics, *changes):
    return changed(SCENE, (NODES, NODES + f"rings = {harmonics}\n"), *changes)


def track(n):
    return f'[{{ name = "track", harmonics = {n} }}]'


class Case:
    """What a scene makes, in a folder of its own."""

    def __init__(self, programs, scene, mpirun=None):
        self.programs = programs
        self.folder = tempfile.TemporaryDirectory()
        self.path = Path(self.folder.name)
        (self.path / "scene.toml").write_text(scene)
        self.mpirun = mpirun

    def command(self, program, *words):
        return [self.programs / program, *words, self.path / "scene.toml", "--output", self.path]

    def summary(self, program, *words):
        ranks = 2 if self.mpirun and program == "chladni" else 1
        return summary(*self.command(program, *words), mpirun=self.mpirun, ranks=ranks)

    def read(self, kind, *names):
        with h5py.File(next(self.path.glob(f"*.{kind}.h5"))) as file:
            return [file[name][()] for name in names]

    def flexibility(self):
        """Of the ring against forces along the axis: W diag(omega^-2) W^T of the body's modes."""
        omega, W = self.read("body", "modes/frequencies", "rings/track/displacement")
        return W / omega**2 @ W.T


def all_harmonics(programs, mpirun):
    """Six harmonics of twelve nodes are another basis of the same space."""
    full, rings = Case(programs, SCENE), Case(programs, with_rings(track(6)))
    parallel = Case(programs, with_rings(track(6)), mpirun)
    ours = [case.summary("chladni", "run")["frequencies_Hz"] for case in (full, rings, parallel)]
    for name, f in (("one rank", ours[1]), ("two ranks", ours[2])):
        worst = np.max(np.abs(np.array(f) / ours[0] - 1))
        yield f"all harmonics, {name}: frequencies equal to {worst:.1e}", worst < 1e-9
    reference = full.flexibility()
    worst = np.abs(rings.flexibility() - reference).max() / reference.max()
    yield f"flexibility of the ring equal to {worst:.1e}", worst < 1e-8
    n = full.read("reduced", "masters/node")[0].size
    yield "as many masters", rings.read("reduced", "masters/node")[0].size == n
    yield from ((line, False) for line in failed_checks(programs, rings.path))


def few_harmonics(programs):
    """Three harmonics: fewer masters, no mode lost, and errors that the certificate knows."""
    scene = with_rings(track(3), ("modes = 20\n", "modes = 40\nsylvester = true\n"))
    case = Case(programs, scene + CLAMPED)
    full = np.array(case.summary("chladni", "modes")["frequencies_Hz"])
    reduced = case.summary("chladni", "reduce")
    info = run(programs / "chladni", "info", next(case.path.glob("*.reduced.h5")))
    case.summary("chladni", "body")
    yield "masters: 7 harmonics and the hub", reduced["n_masters"] == 6 * 7 + 6
    yield "info names the harmonics", "harmonics of track up to" in info
    n = min(20, len(reduced["certified_frequencies_Hz"]))
    f, eta2 = np.array(reduced["certified_frequencies_Hz"][:n]), np.array(reduced["eta2"][:n])
    error = (f / full[:n]) ** 2 - 1
    print("errors", error, "\neta^2 ", eta2)
    # Both eigen-solvers leave some 1e-9 of lambda.
    yield f"{n} modes within eta of the FE model", bool(np.all(np.abs(error) <= np.sqrt(eta2) + 1e-8))
    below = eta2 < 0.05  # where it is an estimate
    yield f"{below.sum()} of them about eta^2 above it", below.sum() > 10 and bool(
        np.all(np.abs(error - eta2)[below] <= 0.3 * eta2[below] + 1e-8)
    )
    count = case.read("reduced", "certificate/counts/expected", "certificate/counts/found")
    yield f"counted: {count[0]} expected, {count[1]} found", count[0][0] == count[1][0]
    bounds = case.read("reduced", "certificate/bounds")[0]
    m = min(len(bounds), n)
    yield f"{m} bounds hold", m > 5 and bool(np.all(bounds[:m] >= error[:m] - 1e-8))
    yield from ((line, False) for line in failed_checks(programs, case.path))


def held_at_its_nodes(programs):
    """All nodes of the ring, of which the harmonics alone are masters; the certificate is for what masters can hold."""
    scene = with_rings(track(3), (SQUEAL, ""), ("modes = 20\n", "modes = 60\n"), ('["hub"]\nkeep', '["track.z"]\nkeep'))
    case = Case(programs, scene + '[[support]]\ngroup = "track"\ndofs = ["z"]\n[modes]\ncount = 12\n')
    body = np.array(case.summary("chladni", "run")["frequencies_Hz"])
    full = np.array(case.summary("chladni", "modes")["frequencies_Hz"])
    n_rigid = np.count_nonzero(body == 0.0)
    error = body[n_rigid:n_rigid + 5] / full[n_rigid:n_rigid + 5] - 1
    print("errors", error)
    yield "the disc moves in its plane", n_rigid == 3
    # Twelve conditions on fourteen harmonics and modes: Ritz values of what is left.
    yield "frequencies from above", bool(np.all(error > -1e-7)) and bool(np.all(error < 0.05))
    yield "the certificate is that of the free disc", case.read("body", "certificate/fixed")[0].size == 0
    yield from ((line, False) for line in failed_checks(programs, case.path))


def squeal(programs):
    """The pair of modes with three diameters squeals at the same speed."""
    speeds = []
    for scene in (SCENE, with_rings(track(3)), with_rings(track(4))):
        case = Case(programs, scene)
        case.summary("chladni", "run")
        speeds.append(case.summary("squeal", "run")["critical_speed_rad_s"])
    print("critical speeds", speeds)
    # Modes that the ring's other harmonics bend converge a little faster: 40 of 200 interior modes.
    for name, speed in zip(("three", "four"), speeds[1:]):
        yield f"critical speed with {name} harmonics", abs(speed / speeds[0] - 1) < 1e-3


def methods(programs):
    """Guyan, Rubin, a tolerance, and responses of the whole model take the same masters."""
    cases = {
        "guyan": ('method = "craig-bampton"\nmodes = 20', 'method = "guyan"'),
        "rubin": ('method = "craig-bampton"', 'method = "rubin"'),
        "tolerance": ("modes = 20\n", "tolerance = 1e-2\nup_to_Hz = 4000.0\n"),
    }
    for name, change in cases.items():
        keep = ("keep = { modes = 30 }", "keep = { modes = 8 }")
        f = []
        for rings in ("[]", track(3)):
            case = Case(programs, with_rings(rings, change, keep))
            f.append(np.array(case.summary("chladni", "run")["frequencies_Hz"])[:3])
            yield from ((f"{name}: {line}", False) for line in failed_checks(programs, case.path))
        # Up to three diameters the modes bend the ring in its first harmonics alone. Guyan's masters
        # have to carry the rest of the disc, too: a few per cent.
        yield f"{name}: {f[1]}", np.allclose(*f, rtol=0.05 if name == "guyan" else 1e-3)
    modes = 'keep = { modes = 8 }\ninterface_modes = [{ kind = "frm", at = "track", dofs = ["z"], space = "full" }]'
    case = Case(programs, with_rings(track(3), ("keep = { modes = 30 }", modes)))
    yield "full responses at the harmonics", len(case.summary("chladni", "run")["frequencies_Hz"]) > 8


def refusals(programs):
    """One message that says what to do, and no file."""
    cases = (
        (with_rings(track(7)), ("interface.rings", "harmonics = 7", "12 nodes", "1 to 6")),
        (with_rings(track(0)), ("harmonics = 0",)),
        (with_rings("[{ harmonics = 3 }]"), ("interface.rings", "name")),
        (with_rings('[{ name = "track" }]'), ("harmonics",)),
        (with_rings('[{ name = "rim", harmonics = 3 }]'), ('"rim"', "interface node")),
        (with_rings('[{ name = "hub", harmonics = 1 }]'), ('"hub"', "1 nodes make no ring")),
        (with_rings('[{ name = "track", harmonics = 3 }, { name = "track", harmonics = 2 }]'), ("twice",)),
        (with_rings(track(3), (SQUEAL, ""), ('fixed = ["hub"]', 'fixed = ["track"]')), ("cannot hold track.",)),
        (with_rings(track(3), ("keep = { modes = 30 }",
                               'interface_modes = [{ kind = "frm", at = "track", dofs = ["x"], space = "full" }]')),
         ("ring of harmonics", "along z and rz only")),
    )  # fmt: skip
    for scene, words in cases:
        case = Case(programs, scene)
        done = start(*case.command("chladni", "run"))
        message = done.stderr.strip()
        print(message)
        good = done.returncode == 1 and all(word in message for word in words) and message.count("\n") < 3
        yield f"refused: {words}", good and not list(case.path.glob("*.body.h5"))


def main(programs, mpirun):
    holds = True
    for claims in (all_harmonics(programs, mpirun), few_harmonics(programs), held_at_its_nodes(programs), squeal(programs), methods(programs),
                   refusals(programs)):  # fmt: skip
        for claim, is_so in claims:
            print(f"{'ok' if is_so else 'FAILED':8}{claim}", flush=True)
            holds = holds and is_so
    return holds


if __name__ == "__main__":
    sys.exit(not main(Path(sys.argv[1]), sys.argv[2]))
