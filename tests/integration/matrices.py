"""A solid disc of other programs' matrices is the disc of our own solids: frequencies, body, growth under the pads.

Usage: matrices.py PROGRAM_DIR MPIRUN

The matrices are CalculiX's where ccx is installed, and our own (`-cms_view_stiffness`) in all formats.
"""

import math
import shutil
import struct
import sys
import tempfile
from pathlib import Path

from running import changed, run, start, summary, told

AROUND, ACROSS, RADII, HEIGHT = 24, 2, (35.0, 160.0), 20.0  # elements around, across; mm
N_RING = AROUND  # corners: those between them move otherwise, and a ring of both is not axisymmetric
NUMBER = 7  # the first node

SCENE = """name = "{name}"

[mesh]
file = "{mesh}"
length_unit = "mm"
{matrices}
rings = [{{ name = "upper", radius = 0.0975, nodes = {ring}, z = 0.02 }}, {{ name = "lower", radius = 0.0975, nodes = {ring}, z = 0.0 }}]
{sections}
[[coupling]]
name = "hub"
group = "BORE"
type = "rigid"

[modes]
count = 16

[interface]
nodes = ["upper", "lower", "hub"]

[reduce]
method = "craig-bampton"
modes = 10

[body]
fixed = ["hub"]
keep = {{ modes = 20 }}

[squeal]
ring = {{ inboard = "lower", outboard = "upper" }}
contact_planes = [0.0, 0.02]
use_modes = "all"
speeds = {{ from_rad_s = 3.0, to_rad_s = 60.0, count = 5 }}
friction = 0.6
pads = [{{ angle_deg = 0.0, stiffness = 6e6, damping = 0.0, preload = 2000.0 }}]
analyses = ["eigenvalues"]
"""
IRON = """
[material.iron]
young = 110e9
poisson = 0.27
density = 7150.0

[[section]]
group = "DISC"
type = "solid"
material = "iron"
"""


class Disc:
    """Hexahedra of order 2 around the z axis."""

    def __init__(self):
        self.number = {}
        self.elements = []
        for i in range(AROUND):
            for j in range(ACROSS):
                place = [(2 * i + a, 2 * j + b, c) for a, b, c in (
                    (0, 0, 0), (0, 2, 0), (2, 2, 0), (2, 0, 0), (0, 0, 2), (0, 2, 2), (2, 2, 2), (2, 0, 2),
                    (0, 1, 0), (1, 2, 0), (2, 1, 0), (1, 0, 0), (0, 1, 2), (1, 2, 2), (2, 1, 2), (1, 0, 2),
                    (0, 0, 1), (0, 2, 1), (2, 2, 1), (2, 0, 1))]  # fmt: skip
                self.elements.append([self.node(*p) for p in place])

    def node(self, i, j, k):
        return self.number.setdefault((i % (2 * AROUND), j, k), NUMBER + 2 * len(self.number))

    def position(self, i, j, k):
        r, phi = RADII[0] + (RADII[1] - RADII[0]) * j / (2 * ACROSS), math.pi * i / AROUND
        return round(r * math.cos(phi), 12), round(r * math.sin(phi), 12), HEIGHT * k / 2  # ccx reads 20 characters

    def bore(self):
        return [n for (_, j, _), n in self.number.items() if j == 0]

    def text(self, kind="C3D20"):
        lines = ["*Node, nset=All"]
        lines += ["{}, {!r}, {!r}, {!r}".format(n, *self.position(*place)) for place, n in self.number.items()]
        if kind:
            lines.append(f"*Element, type={kind}, elset=Disc")
            for e, nodes in enumerate(self.elements, 1):
                lines += [", ".join(map(str, (e, *nodes[:10]))) + ",", ", ".join(map(str, nodes[10:]))]
        lines += ["*Nset, nset=Bore"] + [f"{n}," for n in self.bore()]
        return "\n".join([*lines, ""])


IRON_DECK = """*Material, name=Iron
*Elastic
110e3, 0.27
*Density
7.15e-9
*Solid section, elset=Disc, material=Iron
"""


def petsc_matrix(file):
    """{(row, column): value} of PETSc's binary format."""
    data = file.read_bytes()
    _, n, _, n_entries = struct.unpack(">4i", data[:16])
    lengths = struct.unpack(f">{n}i", data[16 : 16 + 4 * n])
    columns = struct.unpack(f">{n_entries}i", data[16 + 4 * n : 16 + 4 * (n + n_entries)])
    values = struct.unpack(f">{n_entries}d", data[16 + 4 * (n + n_entries) :][: 8 * n_entries])
    entries, at = {}, 0
    for row, length in enumerate(lengths):
        entries |= {(row, columns[k]): values[k] for k in range(at, at + length)}
        at += length
    return entries


def calculix_file(entries, rows):
    return "".join(f"{i + 1} {j + 1} {v:.14e}\n" for (i, j), v in sorted(entries.items()) if i <= j)


def abaqus_file(entries, rows):
    label = ["{},{}".format(*row) for row in rows]
    return "** of a test\n*MATRIX\n" + "".join(f"{label[i]}, {label[j]}, {v:.16e}\n" for (i, j), v in entries.items() if i >= j)


def market_file(entries, rows):
    n = len(rows)
    return f"%%MatrixMarket matrix coordinate real general\n% of a test\n{n} {n} {len(entries)}\n" + "".join(
        f"{i + 1} {j + 1} {v:.17e}\n" for (i, j), v in entries.items())  # fmt: skip


FORMATS = {"calculix": (calculix_file, ".sti", ".mas"), "abaqus": (abaqus_file, "_STIF.mtx", "_MASS.mtx"),
           "market": (market_file, ".K.mm", ".M.mm")}  # fmt: skip


def table(rows):
    return "".join(f"{node}.{c}\n" for node, c in rows)


def matrices_key(stem, kind, dofs=True):
    _, stiffness, mass = FORMATS[kind]
    known = f', dofs = "{stem}.dof"' if dofs else ""
    return f'matrices = {{ stiffness = "{stem}{stiffness}", mass = "{stem}{mass}"{known} }}'


def write(folder, stem, kind, K, M, rows):
    to_text, stiffness, mass = FORMATS[kind]
    (folder / f"{stem}{stiffness}").write_text(to_text(K, rows))
    (folder / f"{stem}{mass}").write_text(to_text(M, rows))
    (folder / f"{stem}.dof").write_text(table(rows))


def scene(folder, name, mesh, matrices="", sections=""):
    file = folder / f"{name}.toml"
    file.write_text(SCENE.format(name=name, mesh=mesh, matrices=matrices, sections=sections, ring=N_RING))
    return file


def apart(found, expected):
    return max((abs(f - e) / e for f, e in zip(found, expected, strict=True) if e > 1.0), default=0.0)


def own_matrices(programs, folder, disc):
    """In N/mm and t, by the nodes in the order of their numbers."""
    lone = folder / "free.toml"
    text = SCENE.format(name="free", mesh="disc.inp", matrices="", sections=IRON, ring=N_RING)
    lone.write_text(text[: text.index("[[coupling]]")] + '[interface]\nnodes = ["upper"]\n[reduce]\nmethod = "craig-bampton"\nmodes = 2\n')
    run(programs / "chladni", "reduce", lone, "--output", folder, "--",
        "-cms_view_stiffness", f"binary:{folder}/K", "-cms_view_mass", f"binary:{folder}/M")  # fmt: skip
    rows = [(node, c) for node in sorted(disc.number.values()) for c in (1, 2, 3)]
    K, M = ({ij: v / 1000.0 for ij, v in petsc_matrix(folder / name).items()} for name in ("K", "M"))
    return K, M, rows


def growth(programs, folder, file):
    run(programs / "chladni", "run", file, "--output", folder)
    return summary(programs / "squeal", "run", file, "--output", folder)


def eigenvalues(value):
    """All lists `lambda` of a summary, as complex numbers."""
    if isinstance(value, list):
        return [x for inner in value for x in eigenvalues(inner)]
    if not isinstance(value, dict):
        return []
    own = [complex(*x) for x in value.get("lambda", [])]
    return own + [x for key, inner in value.items() if key != "lambda" for x in eigenvalues(inner)]


def equal_to_own_solids(programs, folder, disc, mpirun):
    own = scene(folder, "own", "disc.inp", sections=IRON)
    expected = summary(programs / "chladni", "modes", own, "--output", folder)["frequencies_Hz"]
    K, M, rows = own_matrices(programs, folder, disc)
    for kind in FORMATS:
        write(folder, kind, kind, K, M, rows)
        file = scene(folder, kind, "disc.inp", matrices_key(kind, kind, dofs=kind != "abaqus"))
        found = summary(programs / "chladni", "modes", file, "--output", folder)
        if apart(found["frequencies_Hz"], expected) > 1e-9:
            yield f"{kind}: {found['frequencies_Hz']} Hz instead of {expected}"
    points = scene(folder, "points", "points.inp", matrices_key("calculix", "calculix"))
    for ranks in (1, 2, 3):
        found = summary(programs / "chladni", "modes", points, "--output", folder, "--overwrite", mpirun=mpirun, ranks=ranks)
        if apart(found["frequencies_Hz"], expected) > 1e-9:
            yield f"nodes alone on {ranks} ranks: {found['frequencies_Hz']} Hz instead of {expected}"


def on_faces(folder, name):
    """The scene with rings that are no nodes of the mesh."""
    file = folder / f"{name}_faces.toml"
    wide = "radius = 0.1, nodes = 20, on = \"face\", width = 0.02"
    text = changed((folder / f"{name}.toml").read_text(), (f'name = "{name}"', f'name = "{name}_faces"'))
    file.write_text(text.replace(f"radius = 0.0975, nodes = {N_RING}", wide))
    return file.stem


def equal_growth(programs, folder, own, names):
    """The whole chain, Coriolis and centrifugal terms included: growth rates agree to a millionth of the largest."""
    expected = eigenvalues(growth(programs, folder, folder / f"{own}.toml"))
    largest = max((x.real for x in expected), default=0.0)
    for name in names:
        found = eigenvalues(growth(programs, folder, folder / f"{name}.toml"))
        if len(found) != len(expected) or len(found) < 100 or largest < 1.0:
            yield f"{name}: {len(found)} eigenvalues instead of {len(expected)}, growth up to {largest} 1/s"
            continue
        worst = max(abs(min(found, key=lambda y: abs(x - y)).real - x.real) for x in expected)
        print(f"{name}: growth rates up to {largest:.3g} 1/s differ by {worst:.1e} 1/s")
        if worst > 1e-6 * largest:
            yield f"{name}: growth rates differ by {worst:.1e} 1/s"


def of_calculix(programs, folder, disc):
    """Of ccx itself, where it is installed; mass and stiffness agree with ours to the digits of its files."""
    if not shutil.which("ccx"):
        return
    (folder / "ccx.inp").write_text(disc.text() + IRON_DECK + "*Step\n*Frequency, solver=matrixstorage\n*End step\n")
    done = start("ccx", "ccx", cwd=folder)
    if not (folder / "ccx.sti").exists():
        yield f"ccx wrote no matrices: {done.stdout[-300:]}"
        return
    file = scene(folder, "of_ccx", "disc.inp", 'matrices = { stiffness = "ccx.sti", mass = "ccx.mas", dofs = "ccx.dof" }')
    found = summary(programs / "chladni", "modes", file, "--output", folder)["frequencies_Hz"]
    expected = summary(programs / "chladni", "modes", folder / "own.toml", "--output", folder, "--overwrite")["frequencies_Hz"]
    print(f"CalculiX beside our own solids: {apart(found, expected):.1e}")
    if apart(found, expected) > 1e-9:
        yield f"CalculiX: {found} Hz instead of {expected}"


def bad_matrices(programs, folder, disc):
    """One sentence that names file, row and node."""
    K, M, rows = own_matrices(programs, folder, disc)
    node = rows[30][0]
    first = min(ij for ij in K if ij[0] == 30 and ij[1] > 33)

    def tried(name, K=K, M=M, rows=rows, kind="calculix", mesh="disc.inp", edit=None, key=None, extra=()):
        write(folder, "bad", kind, K, M, rows)
        if edit:
            target = folder / f"bad{edit[0]}"
            target.write_text(edit[1](target.read_text()))
        file = scene(folder, "bad", mesh, key or matrices_key("bad", kind, dofs=kind != "abaqus"))
        file.write_text(changed(file.read_text(), *extra))
        done = start(programs / "chladni", "modes", file, "--output", folder / "bad_out")
        return name, done

    def expect(case, *words):
        name, done = case
        said = done.stderr
        if done.returncode != 1 or said.count("\n") != 1 or any(word not in said for word in words):
            yield f"{name}: exit code {done.returncode}, said {said!r} instead of {words}"
        if list((folder / "bad_out").glob("*")):
            yield f"{name}: something was written"

    held = {ij: v + (1e6 if ij == (30, 30) else 0.0) for ij, v in K.items()}
    yield from expect(tried("spring to the ground", K=held), "bad.sti", f"node {node}, DOF 1", "translation along x")
    yield from expect(tried("penalty", K={ij: 1e36 if ij == (30, 30) else v for ij, v in K.items()}), f"node {node}", "supports")
    fewer = [ij for ij in K if 31 not in ij]
    yield from expect(tried("a held DOF", kind="abaqus", K={ij: K[ij] for ij in fewer}, M={ij: v for ij, v in M.items() if 31 not in ij}),
                      f"node {node} has the DOFs 1, 3 alone")  # fmt: skip
    skew = {ij: v * (1.1 if ij == first else 1.0) for ij, v in K.items()}
    yield from expect(tried("unsymmetric", kind="market", K=skew), "bad.K.mm", "other side of the diagonal", f"node {node}, DOF 1")
    half = {ij: v for ij, v in K.items() if ij != first}
    yield from expect(tried("half a pair", kind="market", K=half), "nothing on the other side")
    turned = [rows[3 * (len(rows) // 3 - 1 - k // 3) + k % 3] for k in range(len(rows))]
    yield from expect(tried("another table", rows=turned), "bad.sti", "resists a rotation", "table of nodes")
    yield from expect(tried("a table that is short", rows=rows[:-1]), "bad.sti, line", f"row {len(rows)}", f"{len(rows) - 1} rows")
    yield from expect(tried("a row twice", rows=[*rows[:-1], rows[0]]), "bad.dof", "same node and component")
    yield from expect(tried("a node that is not there", rows=[(99999, 1), *rows[1:]]), "bad.dof, line 1", "no node 99999")
    yield from expect(tried("an internal node", kind="abaqus", edit=("_STIF.mtx", lambda t: t + "-3,1, -3,1, 1.0\n")), "node -3", "internal")
    yield from expect(tried("no table", key=matrices_key("bad", "calculix", dofs=False)), "`dofs` in mesh.matrices")
    yield from expect(tried("cut off", kind="market", edit=(".M.mm", lambda t: t[: t.rindex("\n", 0, -1) + 1])), "bad.M.mm", "entries")
    yield from expect(tried("an entry twice", edit=(".mas", lambda t: t + t.splitlines()[0] + "\n")), "bad.mas", "is there twice")
    yield from expect(tried("no number", edit=(".sti", lambda t: t.replace("1 1 ", "1 1 x", 1))), "bad.sti, line 1", "no number")
    light = {ij: v * (2.0 if ij[0] % 3 == ij[1] % 3 == 1 else 1.0) for ij, v in M.items()}
    yield from expect(tried("a mass of no body", M=light), "bad.mas", "mass of no body", "along y")
    yield from expect(tried("no stiffness", K={ij: (0.0 if ij == (30, 30) else v) for ij, v in K.items()}), f"node {node}, DOF 1", "must be positive")
    yield from expect(tried("sections too", extra=(("[modes]", IRON + "[modes]"),)), "section", "mesh.matrices")
    yield from expect(tried("no such file", key=matrices_key("none", "calculix")), "stiffness", "no file")


def main():
    programs, mpirun = Path(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory() as name:
        folder, disc = Path(name), Disc()
        (folder / "disc.inp").write_text(disc.text())
        (folder / "points.inp").write_text(disc.text(kind=None))
        problems = [
            *equal_to_own_solids(programs, folder, disc, mpirun),
            *of_calculix(programs, folder, disc),
            *equal_growth(programs, folder, "own", ("calculix", "points")),
            *equal_growth(programs, folder, on_faces(folder, "own"), (on_faces(folder, "calculix"),)),
            *bad_matrices(programs, folder, disc),
        ]
    return told(problems)


if __name__ == "__main__":
    sys.exit(main())
