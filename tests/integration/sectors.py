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
method = "{method}"
cutoff_Hz = 9000.0
mass_integrals = true
sylvester = true
pictures = "vertices"
resultants = ["disc"]
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


def tensors(case):
    """Where the disc has section forces, by place, and their response to forces along the axis at the ring: each
    kind as what it is in the mesh's axes, since those of the file are turned with the sectors."""
    omega, W = case.read("body", "modes/frequencies", "rings/track/displacement")
    x, axes, S = case.read("body", *(f"resultants/disc/{name}" for name in ("positions", "axes", "modes")))
    kinds = [kind.decode() for kind in case.read("body", "resultants/disc/kinds")[0]]
    response = (S / omega**2 @ W.T).reshape(len(x), len(kinds), -1)
    e = axes.reshape(-1, 3, 3)
    parts = []
    for tensor in {kind[0] for kind in kinds if kind[0] != "Q"}:
        for name in ("x", "y", "xy"):
            a, b = ("xy".index(name[0]), "xy".index(name[-1]))
            E = np.einsum("pi,pj->pij", e[:, a], e[:, b])
            E = 0.5 * (E + E.transpose(0, 2, 1)) * (2 if name == "xy" else 1)
            parts.append((tensor, np.einsum("pij,pr->pijr", E, response[:, kinds.index(f"{tensor}_{name}")])))
    shear = sum(np.einsum("pi,pr->pir", e[:, k], response[:, kinds.index(f"Q_{n}")]) for k, n in enumerate("xy"))
    order = np.lexsort(np.round(x, 7).T + 0.0)
    sums = {name: sum(part for kind, part in parts if kind == name) for name, _ in parts} | {"Q": shear}
    return x[order], {name: value[order] for name, value in sums.items()}


def same_forces(name, part, whole):
    x, ours = tensors(part)
    y, theirs = tensors(whole)
    yield f"{name}: {len(x)} points with section forces", np.allclose(x, y, atol=1e-9) and set(ours) == set(theirs)
    least = np.abs(theirs["M"]).max()  # in 1/m times those of the membrane, which a flat disc does not have
    for kind, reference in theirs.items():
        off = np.abs(ours[kind] - reference).max() / max(np.abs(reference).max(), least)
        yield f"{name}: {kind} of all sectors under forces at the ring equal to {off:.1e}", off < 1e-7


def drawn_motion(case):
    """Where the nodes of the picture are, and how they move for forces along the axis at the ring."""
    x, U, omega, W = case.read("body", "picture/positions", "picture/displacements", "modes/frequencies", "rings/track/displacement")
    return x, (U / omega**2 @ W.T).reshape(len(x), 3, -1)


def same_picture(programs, name, part, whole):
    """The file of the reduced system holds the motion of one sector, by which the next program draws all."""
    x, reference = drawn_motion(whole)
    y, motion = drawn_motion(part)  # those of the cut edges are drawn with both sectors
    node_at = {tuple(place): i for i, place in enumerate(np.round(x, 7) + 0.0)}
    nodes = [node_at.get(tuple(place)) for place in np.round(y, 7) + 0.0]
    met = None not in nodes and set(nodes) == set(range(len(x)))
    off = np.abs(motion - reference[nodes]).max() / np.abs(reference).max() if met else np.inf
    yield f"{name}: {len(x)} nodes of the picture move alike to {off:.1e}", off < 1e-7
    with h5py.File(next(part.path.glob("*.reduced.h5"))) as file:
        stored = file["picture/sectors/x"].shape[0] + file["picture/sectors/y"].shape[0]
        yield f"{name}: {stored} rows of {3 * len(y)} stand in the file", stored < 3 * len(y) and "displacements" not in file["picture"]
    summary(programs / "chladni", "body", part.path / "scene.toml", "--output", part.path)
    off = np.abs(drawn_motion(part)[1] - motion).max() / np.abs(motion).max()
    yield f"{name}: a body made of the file moves alike to {off:.1e}", off < 1e-12


def same(programs, shape, sectors, mpirun):
    """Frequencies, matrices at the ring, response and critical speed of sector and whole body."""
    name, shape = shape["generator"], {"method": "craig-bampton"} | shape
    scene = DISC
    if "harmonics" in shape:
        scene = changed(DISC, ("harmonics = 12", f"harmonics = {shape['harmonics']}"))
        name += f" with {shape['harmonics']} harmonics"
    if shape["method"] != "craig-bampton":
        name += f" by {shape['method']}"
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
    yield from same_forces(name, part, whole)
    yield from same_picture(programs, name, part, whole)
    off = worst(part.squeal["critical_speed_rad_s"], whole.squeal["critical_speed_rad_s"])
    yield f"{name}: critical speed equal to {off:.1e}", off < 1e-10
    (omega,) = part.read("reduced", "fixed_interface_frequencies")
    split = split_of_pairs(np.sort(omega))
    yield f"{name}: pairs split by {split:.1e}", split < 1e-12
    yield from ((line, False) for line in failed_checks(programs, part.path))
    if shape["method"] == "mixed-interface":  # which has all of them
        counts = [(c.reduced["modes_found"], c.reduced["modes_expected"]) for c in (part, whole)]
        yield f"{name}: all modes of the range are there", all(n == expected > 20 for n, expected in counts)
    ours, theirs = (c.read("reduced", "certificate/frequencies", "certificate/eta2") for c in (part, whole))
    common = min(len(ours[0]), len(theirs[0]))
    yield f"{name}: {common} certified frequencies", common > 20
    off = worst(ours[0][:common], theirs[0][:common])
    yield f"{name}: certified frequencies equal to {off:.1e}", off < 1e-9
    yield f"{name}: error estimates are those of the whole", np.allclose(ours[1][:common], theirs[1][:common], rtol=1e-2,
                                                                        atol=1e-11)


EXACT = """
name = "exact"
[mesh]
generator = "annulus"
inner_radius = {r_i}
outer_radius = {r_a}
element_size = 0.0072
element_order = 4
pattern = "structured"
sectors = 140
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


def patched(n_made, n_sectors=6, joined=False, twist=0.0):
    """A .geo of a structured disc, or of one of its sectors, with the edge of a patch inside of each sector; twisted, a
    sector has no mirror."""
    radii, angles = (25, 60, 110, 162), range(3 * n_made + (n_made < n_sectors))
    lines = ["Point(1) = {0, 0, 0};"]
    point = {(a, i): 2 + 4 * k + i for k, a in enumerate(angles) for i in range(4)}
    for (a, i), tag in point.items():
        phi = 2 * np.pi * a / (3 * n_sectors) + twist * i * (3 - i)
        lines.append(f"Point({tag}) = {{{radii[i] * np.cos(phi):.15g}, {radii[i] * np.sin(phi):.15g}, 0}};")
    following = {a: (a + 1) % (3 * n_sectors) for a in range(3 * n_made)}
    ray = {(a, i): 1000 + 4 * a + i for a in angles for i in range(3)}
    arc = {(a, i): 2000 + 4 * a + i for a in following for i in range(4)}
    lines += [f"Line({tag}) = {{{point[a, i]}, {point[a, i + 1]}}};" for (a, i), tag in ray.items()]
    lines += [f"Circle({tag}) = {{{point[a, i]}, 1, {point[following[a], i]}}};" for (a, i), tag in arc.items()]
    for a, after in following.items():
        for i in range(3):
            tag = 3000 + 4 * a + i
            lines.append(f"Curve Loop({tag}) = {{{ray[a, i]}, {arc[a, i + 1]}, -{ray[after, i]}, -{arc[a, i]}}};")
            lines.append(f"Plane Surface({tag}) = {{{tag}}}; Transfinite Surface {{{tag}}}; Recombine Surface {{{tag}}};")
    named = {"inner_edge": [arc[a, 0] for a in following]}
    for j in range(n_made):
        a = 3 * j + 1
        edge = [ray[a, 1], arc[a, 2], ray[following[a], 1], arc[a, 1]]
        named.setdefault("patches" if joined else f"patch_{j}", []).extend(edge)

    def listed(tags):
        return "{" + ", ".join(map(str, tags)) + "}"

    lines.append(f"Transfinite Curve {listed([*ray.values(), *arc.values()])} = 3;")
    lines.append(f'Physical Surface("disc") = {listed(3000 + 4 * a + i for a in following for i in range(3))};')
    if n_made == n_sectors and not joined:
        lines.append(f'Physical Point("spot") = {{{point[0, 3]}}};')
    lines += [f'Physical Curve("{name}") = {listed(tags)};' for name, tags in named.items()]
    return "\n".join(lines) + "\n"


MEANS = """
name = "means"
[mesh]
file = "disc.geo"
length_unit = "mm"
element_order = 2
{sectors}
rings = [{{ name = "track", radius = 0.162, nodes = 72 }}]
[material.iron]
young = 9.15915e10
poisson = 0.3
density = 6300.0
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = 0.02
[[coupling]]
type = "rigid"
name = "hub"
group = "inner_edge"
{means}
[interface]
nodes = ["hub", "track"]
rings = [{{ name = "track", harmonics = 9 }}]
[reduce]
method = "craig-bampton"
cutoff_Hz = 9000.0
[body]
fixed = ["hub"]
keep = {{ up_to_Hz = 5000.0 }}
"""
MEAN = """[[coupling]]
type = "averaging"
name = "mean_{0}"
group = "patch_{0}"
[[mass]]
at = "mean_{0}"
mass = 0.3
inertia = [1e-4, 1e-4, 1e-4, 0.0, 0.0, 0.0]
"""


def means(programs):
    """Masses at the means of patches, one in each sector; a patch that several sectors share is none."""
    frequencies = []
    for n_made, sectors in ((6, ""), (1, "sectors = 6")):
        with tempfile.TemporaryDirectory() as name:
            path = Path(name)
            (path / "disc.geo").write_text(patched(n_made))
            scene = MEANS.format(sectors=sectors, means="".join(MEAN.format(j) for j in range(n_made)))
            (path / "scene.toml").write_text(scene)
            done = start(programs / "chladni", "run", path / "scene.toml", "--output", path)
            if done.returncode != 0:
                yield f"means: {done.stderr}", False
                return
            with h5py.File(next(path.glob("*.body.h5"))) as file:
                frequencies.append(np.sort(file["modes/frequencies"][()]))
    off = worst(frequencies[1], frequencies[0])
    yield f"means of patches: {len(frequencies[0])} frequencies of the body equal to {off:.1e}", off < 1e-9
    with tempfile.TemporaryDirectory() as name:
        path = Path(name)
        (path / "disc.geo").write_text(patched(1))
        for group, nodes, words in (
                ("inner_edge", '"hub", "track"', "on a cut edge"),
                ("patch_0", '"hub", "track", "mean_0"', "no interface node")):
            mean = MEAN.format(0).replace("patch_0", group)
            scene = MEANS.format(sectors="sectors = 6", means=mean).replace('"hub", "track"', nodes)
            (path / "scene.toml").write_text(scene.replace('group = "inner_edge"\n[[coupling]]', 'group = "patch_0"\n[[coupling]]')
                                             if group == "inner_edge" else scene)
            done = start(programs / "chladni", "reduce", path / "scene.toml", "--output", path)
            yield f"means refused: {words}", done.returncode != 0 and words in done.stderr
        # Patches of all sectors that follow one node are no coupling of a sector.
        (path / "disc.geo").write_text(patched(6, joined=True))
        joined = '[[coupling]]\ntype = "rigid"\nname = "all"\ngroup = "patches"\n[[mass]]\nat = "all"\nmass = 0.3\n'
        (path / "scene.toml").write_text(MEANS.format(sectors='sectors = "auto"', means=joined))
        done = start(programs / "chladni", "reduce", path / "scene.toml", "--output", path)
        yield "patches of all sectors that follow one node", (
            done.returncode == 0 and '"all" joins nodes of several sectors' in done.stderr and "whole body" in done.stderr)


def twisted(programs):
    """A sector without a mirror, by all methods: pairs are found among modes that a solver mixes."""
    for method in ("craig-bampton", "mixed-interface", "rubin"):
        frequencies = []
        for n_made, sectors in ((6, ""), (1, "sectors = 6")):
            with tempfile.TemporaryDirectory() as name:
                path = Path(name)
                (path / "disc.geo").write_text(patched(n_made, twist=0.1))
                scene = MEANS.format(sectors=sectors, means="")
                (path / "scene.toml").write_text(changed(scene, ("craig-bampton", method)))
                summary(programs / "chladni", "run", path / "scene.toml", "--output", path)
                with h5py.File(next(path.glob("*.body.h5"))) as file:
                    frequencies.append(np.sort(file["modes/frequencies"][()]))
        off = worst(frequencies[1], frequencies[0])
        yield f"twisted, {method}: {len(frequencies[0])} frequencies of the body equal to {off:.1e}", off < 1e-9


def held_frequencies(K, M, held):
    """Of a reduced model, rad/s, without the rows that are held; by the factor of K, which has the lowest to all digits."""
    kept = np.setdiff1d(np.arange(len(K)), held)
    L = np.linalg.inv(np.linalg.cholesky(K[np.ix_(kept, kept)]))
    return 1.0 / np.sqrt(np.linalg.eigvalsh(L @ M[np.ix_(kept, kept)] @ L.T)[::-1])


def first_frequencies(programs, n_made, harmonics, mass):
    """Of the disc, rad/s, and how they move with a mass at a node of the ring that is added to the reduced model."""
    sectors = "sectors = 6" if n_made == 1 else ""
    spot = f'[[mass]]\nat = "spot"\nmass = {mass}\n' if n_made > 1 else ""
    scene = changed(MEANS.format(sectors=sectors, means=spot), ("harmonics = 9", f"harmonics = {harmonics}"),
                    ("cutoff_Hz = 9000.0", "cutoff_Hz = 30000.0"))
    with tempfile.TemporaryDirectory() as name:
        path = Path(name)
        (path / "disc.geo").write_text(patched(n_made))
        (path / "scene.toml").write_text(scene)
        summary(programs / "chladni", "reduce", path / "scene.toml", "--output", path)
        with h5py.File(path / "means.reduced.h5") as file:
            K, M, T, x, hub = (file[key][()] for key in (
                "matrices/stiffness", "matrices/mass", "attachment/displacements", "attachment/node_positions",
                "attachment/sets/hub"))
            held = np.flatnonzero(np.isin(file["masters/node"][()], hub))
    row = 6 * np.argmin(np.linalg.norm(x - [0.162, 0.0, 0.0], axis=1))
    T = T[row : row + 3]
    return [held_frequencies(K, M + added * T.T @ T, held)[:10] for added in ((mass, 0.0) if n_made == 1 else (0.0,))]


def mistuned(programs):
    """A mass at one node of the perfect disc couples all harmonics of the model that was reduced from a sector: against
    the FE model of the disc with the mass. All harmonics of the ring have it exactly, a few to some of what it does."""
    for harmonics, mass in ((36, 0.02), (9, 0.02)):
        (full,), (ours, perfect) = (first_frequencies(programs, n, harmonics, mass) for n in (6, 1))
        off = np.max(np.abs(ours / full - 1))
        moved = np.max(np.abs(perfect / full - 1))
        yield f"{mass} kg at the ring of {harmonics} harmonics: {moved:.1e} moved, {off:.1e} off", (
            moved > 1e-3 and off < (1e-9 if harmonics == 36 else 0.02 * moved))


def responses_of(programs, sectors, reduce, keep=None):
    """u_z of the ring's nodes for forces there, at the dozen frequencies of the bound, and the bound."""
    scene = changed(DISC.format(sectors=sectors, method="mixed-interface", **ANNULUS), ("cutoff_Hz = 9000.0", reduce),
                    ("keep = { up_to_Hz = 7000.0 }", keep or "keep = { up_to_Hz = 7000.0 }"), ('resultants = ["disc"]\n', ""))
    with tempfile.TemporaryDirectory() as name:
        path = Path(name)
        (path / "scene.toml").write_text(scene)
        summary(programs / "chladni", "run", path / "scene.toml", "--output", path)
        with h5py.File(path / "disc.reduced.h5") as file:
            K, M, T, hub, track = (file[key][()] for key in (
                "matrices/stiffness", "matrices/mass", "attachment/displacements", "attachment/sets/hub", "attachment/sets/track"))
            free = np.setdiff1d(np.arange(len(K)), np.flatnonzero(np.isin(file["masters/node"][()], hub)))
            bound = file["certificate/responses/error"][()] if "certificate/responses" in file else None
            up_to = file["certificate/responses/up_to"][()] if bound is not None else None
        of_body = None
        if bound is not None:
            with h5py.File(path / "disc.body.h5") as file:
                of_body = file["selection/error_of_reduction"][()]
    F = T[6 * track + 2][:, free].T
    Omega = np.arange(1, 13) / 12 * 2 * np.pi * 5000.0
    u = [F.T @ np.linalg.solve(K[np.ix_(free, free)] - w**2 * M[np.ix_(free, free)], F) for w in Omega]
    return u, bound, up_to, of_body


def certified_responses(programs):
    """The bound that the harmonics give together holds, and is not far from the error."""
    reference, *_ = responses_of(programs, "", "cutoff_Hz = 40000.0")
    tolerance = "tolerance = 1e-3\nup_to_Hz = 5000.0"
    keep = "keep = { tolerance = 1e-3, up_to_Hz = 5000.0 }"
    for sectors in ("sectors = 8", 'sectors = "auto"'):
        u, bound, up_to, of_body = responses_of(programs, sectors, tolerance, keep)
        error = max(np.max(np.linalg.norm(a - b, axis=0) / np.linalg.norm(b, axis=0)) for a, b in zip(u, reference))
        yield f"responses by {sectors}: error {error:.1e}, bound {bound:.1e}, asked 3.3e-04", (
            1e-7 < error <= bound < 3.4e-4 and bound < 50 * error and of_body == bound and abs(up_to / (2e4 * np.pi / 2) - 1) < 1e-12)


def shared(programs, mpirun):
    """Harmonics that several ranks share, with a mirror and without: as on one rank."""
    plain = DISC.format(sectors="sectors = 8", method="craig-bampton", **ANNULUS)
    twisted_scene = MEANS.format(sectors="sectors = 6", means="")
    for name, scene, geo in (("a disc", plain, None), ("a twisted disc", twisted_scene, patched(1, twist=0.1))):
        found = {}
        for ranks, each in ((1, None), (3, 2), (4, 2)) if geo is None else ((1, None), (3, 2)):
            text = scene if each is None else changed(scene, ("[reduce]", f"[reduce]\nranks_per_harmonic = {each}"))
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder)
                (path / "scene.toml").write_text(text)
                if geo:
                    (path / "disc.geo").write_text(geo)
                summary(programs / "chladni", "run", path / "scene.toml", "--output", path, mpirun=mpirun, ranks=ranks)
                with h5py.File(next(path.glob("*.reduced.h5"))) as file:
                    n = len(file["masters/kind"])
                    arrays = [file["matrices/stiffness"][:n, :n], file["matrices/mass"][:n, :n], file["certificate/frequencies"][()],
                              file["fixed_interface_frequencies"][()], file["mass_integrals/displacement"][:, :n]]
                    harmonics = np.sort(file["sectors/harmonics"][()])
                with h5py.File(next(path.glob("*.body.h5"))) as file:
                    of_modes = file["sectors/harmonics"][()]
                found[ranks] = arrays, harmonics, of_modes
        for ranks in list(found)[1:]:
            off = max(np.abs(a - b).max() / np.abs(b).max() for a, b in zip(found[ranks][0], found[1][0]))
            same_harmonics = all(np.array_equal(a, b) for a, b in zip(found[ranks][1:], found[1][1:]))
            yield f"{name} by {ranks} ranks, two or more for a harmonic: equal to {off:.1e}", off < 1e-9 and same_harmonics
        yield f"{name}: each mode of the body is of one harmonic", found[1][2].min() >= 0


def refused(programs):
    """What does not repeat is named."""
    good = DISC.format(sectors="sectors = 8", method="craig-bampton", **ANNULUS)
    for change, words in (
            (("nodes = 24", "nodes = 28"), "do not repeat in 8 sectors"),
            (("inertia = [1e-4, 1e-4", "inertia = [1e-4, 3e-4"), "does not look the same from each sector"),
            (('pattern = "structured"', 'pattern = "unstructured"'), "structured"),
            (("sectors = 8", "sectors = 2"), "sectors"),
            (("sectors = 8", 'sectors = "eight"'), "auto"),
            (("[reduce]", "[reduce]\nranks_per_harmonic = 0"), "ranks_per_harmonic")):
        with tempfile.TemporaryDirectory() as name:
            scene = Path(name) / "scene.toml"
            scene.write_text(changed(good, change))
            done = start(programs / "chladni", "reduce", scene, "--output", name)
            yield f"refused: {words}", done.returncode != 0 and words in done.stderr


def main(programs, mpirun):
    good = True
    fewer = ANNULUS | {"harmonics": 3}  # than the sectors have: some of theirs have no master
    mixed, rubin = (shape | {"method": method} for shape, method in ((HAT, "mixed-interface"), (ANNULUS, "rubin")))
    for shape, sectors, launcher in ((ANNULUS, 8, None), (HAT, 6, mpirun), (fewer, '"auto"', None),
                                     (mixed, 6, None), (rubin, 8, None)):
        for line, holds in same(programs, shape, sectors, launcher):
            print(line if holds else f"FAILED: {line}")
            good = good and holds
    for line, holds in [*exact(programs), *found(programs), *means(programs), *twisted(programs), *mistuned(programs), *certified_responses(programs), *shared(programs, mpirun), *refused(programs)]:
        print(line if holds else f"FAILED: {line}")
        good = good and holds
    return good


if __name__ == "__main__":
    sys.exit(not main(Path(sys.argv[1]), sys.argv[2]))
