"""One sector and the whole body: the same frequencies, masses, certificates and critical speed, in exact pairs.

Usage: sectors.py PROGRAM_DIR MPIRUN
"""

import json
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

from running import changed, start, summary

from checked import failed_checks

DISC = """
name = "disc"
[mesh]
generator = "{generator}"
{shape}
element_order = 3
pattern = "structured"
{sectors}
rings = [{{ name = "track", radius = 0.13, nodes = 24 }}]
[material.iron]
young = 9.15915e10
poisson = 0.3
density = 6300.0
{sections}
[[coupling]]
type = "rigid"
name = "hub"
group = "{held}"
[[mass]]
at = "hub"
mass = 0.4
inertia = [1e-4, 1e-4, 2e-4, 0.0, 0.0, 0.0]
[interface]
nodes = ["hub", "track"]
rings = [{{ name = "track", harmonics = 12 }}]
[reduce]
method = "craig-bampton"
cutoff_Hz = 9000.0
mass_integrals = true
sylvester = true
pictures = "vertices"
[body]
fixed = ["hub"]
keep = {{ up_to_Hz = 7000.0 }}
[squeal]
ring = "track"
thickness = 0.02
speeds = {{ from_rad_s = 3.0, to_rad_s = 60.0, count = 8 }}
friction = 0.6
contact = "bilateral"
pads = [{{ angle_deg = 20.0, stiffness = 6e6, damping = 0.0, preload = 2000.0 }}]
analyses = ["eigenvalues", "critical-speed"]
"""
SECTION = '[[section]]\ngroup = "{}"\ntype = "shell"\nmaterial = "iron"\nthickness = {}\n'
ANNULUS = {"generator": "annulus", "shape": "inner_radius = 0.025\nouter_radius = 0.162\nelement_size = 0.04",
           "sections": SECTION.format("disc", 0.02), "held": "inner_edge"}
HAT = {"generator": "hat_disc", "shape": "outer_radius = 0.162\nwall_radius = 0.09\ntop_radius = 0.085\n"
       "hub_radius = 0.03\nheight = 0.05\nelement_size = 0.045",
       "sections": SECTION.format("disc", 0.02) + SECTION.format("wall", 0.01) + SECTION.format("flange", 0.01),
       "held": "hub_edge"}


class Case:
    """The files of a scene, in a folder of its own."""

    def __init__(self, programs, scene, mpirun=None, ranks=1):
        self.folder = tempfile.TemporaryDirectory()
        self.path = Path(self.folder.name)
        (self.path / "scene.toml").write_text(scene)
        words = (self.path / "scene.toml", "--output", self.path)
        self.reduced = summary(programs / "chladni", "run", *words, mpirun=mpirun, ranks=ranks)
        self.squeal = summary(programs / "squeal", "run", *words)

    def read(self, kind, *names):
        with h5py.File(next(self.path.glob(f"*.{kind}.h5"))) as file:
            return [file[name][()] for name in names]

    def attrs(self, kind, group):
        with h5py.File(next(self.path.glob(f"*.{kind}.h5"))) as file:
            return dict(file[group].attrs)

    def flexibility(self):
        """Of the ring against forces along the axis."""
        omega, W = self.read("body", "modes/frequencies", "rings/track/displacement")
        return W / omega**2 @ W.T


def worst(a, b):
    return np.max(np.abs(np.asarray(a) / np.asarray(b) - 1))


def split_of_pairs(omega):
    """The largest relative distance within a pair, of all modes that have a neighbour nearer than 1e-6."""
    gaps = np.diff(omega) / omega[1:]
    return max(gaps[gaps < 1e-6], default=0.0)


def blocks(A, n):
    """What does not depend on the phase of a pair: entries of the masters, norms of the rest."""
    if A.ndim == 2 and A.shape[0] == A.shape[1]:
        return np.concatenate([A[:n, :n].ravel(), np.linalg.norm(A[n:, :n], axis=0), [np.linalg.norm(A[n:, n:])]])
    if A.ndim == 2:
        return np.concatenate([A[:, :n].ravel(), np.linalg.norm(A[:, n:], axis=1)])
    return np.ravel(A)


def same_integrals(name, part, whole, n):
    """Those over the mass."""
    with h5py.File(next(whole.path.glob("*.reduced.h5"))) as file:
        keys = list(file["mass_integrals"])
    for key in keys:
        ours, theirs = (c.read("reduced", f"mass_integrals/{key}")[0] for c in (part, whole))
        same_size = len(np.shape(theirs)) < 2 or np.shape(theirs)[1] == 3
        a, b = (np.ravel(ours), np.ravel(theirs)) if same_size else (blocks(ours, n), blocks(theirs, n))
        smallest = 1e-3 if key == "first_moment" else 0.0  # of a flat disc it vanishes
        off = np.abs(a - b).max() / max(np.abs(b).max(), smallest)
        yield f"{name}: mass integrals {key} equal to {off:.1e}", off < 1e-9


def same(programs, shape, sectors, mpirun):
    """Frequencies, matrices at the ring, response and critical speed of sector and whole body."""
    name = shape["generator"]
    scene = DISC
    if "harmonics" in shape:
        scene = changed(DISC, ("harmonics = 12", f"harmonics = {shape['harmonics']}"))
        name += f" with {shape['harmonics']} harmonics"
    whole = Case(programs, scene.format(sectors="", **shape))
    part = Case(programs, scene.format(sectors=f"sectors = {sectors}", **shape), mpirun, 2 if mpirun else 1)
    yield f"{name}: as many DOFs, masters and modes", all(
        whole.reduced[key] == part.reduced[key] for key in ("n_dofs", "n_masters", "n_modes"))
    off = worst(part.reduced["frequencies_Hz"], whole.reduced["frequencies_Hz"])
    yield f"{name}: frequencies of the body equal to {off:.1e}", off < 1e-9
    K, M, n = [], [], whole.reduced["n_masters"]
    for case in (part, whole):
        k, m = case.read("reduced", "matrices/stiffness", "matrices/mass")
        K.append(k[:n, :n])
        M.append(m[:n, :n])
    off = max(np.abs(a[0] - a[1]).max() / np.abs(a[1]).max() for a in (K, M))
    yield f"{name}: K and M of the masters equal to {off:.1e} of their largest entry", off < 1e-9
    reference = whole.flexibility()
    off = np.abs(part.flexibility() - reference).max() / reference.max()
    yield f"{name}: flexibility of the ring equal to {off:.1e}", off < 1e-8
    yield from same_integrals(name, part, whole, n)
    off = worst(part.squeal["critical_speed_rad_s"], whole.squeal["critical_speed_rad_s"])
    yield f"{name}: critical speed equal to {off:.1e}", off < 1e-8
    (omega,) = part.read("reduced", "fixed_interface_frequencies")
    split = split_of_pairs(np.sort(omega))
    yield f"{name}: pairs split by {split:.1e}", split < 1e-12
    ours, theirs = (c.read("reduced", "certificate/frequencies", "certificate/eta2") for c in (part, whole))
    common = min(len(ours[0]), len(theirs[0]))
    yield f"{name}: {common} certified frequencies", common > 20
    off = worst(ours[0][:common], theirs[0][:common])
    yield f"{name}: certified frequencies equal to {off:.1e}", off < 1e-9
    yield f"{name}: error estimates are those of the whole", np.allclose(ours[1][:common], theirs[1][:common], rtol=1e-2,
                                                                        atol=1e-11)
    yield from ((line, False) for line in failed_checks(programs, part.path))


EXACT = """
name = "exact"
[mesh]
generator = "annulus"
inner_radius = {r_i}
outer_radius = {r_a}
element_size = 0.006
element_order = 4
pattern = "structured"
sectors = 168
[material.iron]
young = {young}
poisson = {nu}
density = {density}
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = {h}
[[coupling]]
type = "rigid"
name = "hub"
group = "inner_edge"
[interface]
nodes = ["hub"]
[reduce]
method = "craig-bampton"
cutoff_Hz = 10000.0
pictures = "none"
mass_integrals = false
"""


def exact(programs):
    """A plain disc of which a sector has one element around: frequencies of the exact Mindlin plate."""
    data = json.loads((Path(__file__).parents[2] / "benchmarks/elements/exact_annulus.json").read_text())
    h = data["r_a"] / 8.1
    young = 12 * data["D"] * (1 - data["nu"] ** 2) / h**3
    with tempfile.TemporaryDirectory() as name:
        path = Path(name)
        (path / "scene.toml").write_text(EXACT.format(h=h, young=young, density=data["gamma"] / h, **data))
        summary(programs / "chladni", "reduce", path / "scene.toml", "--output", path)
        with h5py.File(path / "exact.reduced.h5") as file:
            f_Hz = file["fixed_interface_frequencies"][()] / (2 * np.pi)
    expected = [f for of_order in data["f_Hz[r_a/h][n][m]"]["8.1"] for f in of_order if f < 9900]
    off = max(np.abs(f_Hz / f - 1).min() for f in expected)
    yield f"{len(expected)} exact frequencies of a Mindlin plate, to {off:.1e}", off < 1e-8 and len(expected) > 10


def found(programs):
    """A disc with vanes, whose 24 sectors are found in the mesh of a .geo; the vanes lie in its cuts."""
    data = Path(__file__).parents[1] / "data"
    scene = (data / "ventilated_disc.toml").read_text().replace('"ventilated_disc.geo"', f'"{data / "ventilated_disc.geo"}"')
    frequencies = []
    for text in (scene, changed(scene, ("element_order = 2", 'element_order = 2\nsectors = "auto"'))):
        with tempfile.TemporaryDirectory() as name:
            path = Path(name)
            (path / "scene.toml").write_text(text)
            done = start(programs / "chladni", "run", path / "scene.toml", "--output", path)
            assert done.returncode == 0, done.stderr
            with h5py.File(next(path.glob("*.body.h5"))) as file:
                frequencies.append(np.sort(file["modes/frequencies"][()]))
    yield "24 sectors are found", "repeats 24 times" in done.stderr
    off = worst(frequencies[1], frequencies[0])
    yield f"vanes: frequencies of the body equal to {off:.1e}", off < 1e-9


def refused(programs):
    """What does not repeat is named."""
    good = DISC.format(sectors="sectors = 8", **ANNULUS)
    for change, words in (
            (("nodes = 24", "nodes = 28"), "do not repeat in 8 sectors"),
            (("inertia = [1e-4, 1e-4", "inertia = [1e-4, 3e-4"), "does not look the same from each sector"),
            (('pattern = "structured"', 'pattern = "unstructured"'), "structured"),
            (("sectors = 8", "sectors = 2"), "sectors"),
            (("sectors = 8", 'sectors = "eight"'), "auto"),
            (('"craig-bampton"\ncutoff_Hz = 9000.0', '"rubin"\nmodes = 20'), "craig-bampton")):
        with tempfile.TemporaryDirectory() as name:
            scene = Path(name) / "scene.toml"
            scene.write_text(changed(good, change))
            done = start(programs / "chladni", "reduce", scene, "--output", name)
            yield f"refused: {words}", done.returncode != 0 and words in done.stderr


def main(programs, mpirun):
    good = True
    fewer = ANNULUS | {"harmonics": 3}  # than the sectors have: some of theirs have no master
    for shape, sectors, launcher in ((ANNULUS, 8, None), (HAT, 6, mpirun), (fewer, '"auto"', None)):
        for line, holds in same(programs, shape, sectors, launcher):
            print(line if holds else f"FAILED: {line}")
            good = good and holds
    for line, holds in [*exact(programs), *found(programs), *refused(programs)]:
        print(line if holds else f"FAILED: {line}")
        good = good and holds
    return good


if __name__ == "__main__":
    sys.exit(not main(Path(sys.argv[1]), sys.argv[2]))
