"""`chladni static` and `chladni modes` against closed forms, and their pictures against the summary.

Usage: static_and_modes.py PROGRAM_DIR MPIRUN
"""

import base64
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np

from running import summary

# A strip without Poisson's effect is a Timoshenko beam, whatever its width.
LENGTH, WIDTH, THICKNESS, YOUNG, DENSITY = 2.0, 0.5, 0.1, 2e11, 8000.0
STRIP_GEO = f"""
SetFactory("OpenCASCADE");
Rectangle(1) = {{0, 0, 0, {LENGTH}, {WIDTH}}};
Mesh.MeshSizeMin = 0.25;
Mesh.MeshSizeMax = 0.25;
Physical Surface("strip") = {{1}};
Physical Curve("tip") = {{2}};
Physical Curve("root") = {{4}};
"""
STRIP = f"""
name = "strip"
[mesh]
file = "strip.geo"
element_order = 2
[material.steel]
young = {YOUNG}
poisson = 0.0
density = {DENSITY}
[[section]]
group = "strip"
type = "shell"
material = "steel"
thickness = {THICKNESS}
[[support]]
group = "root"
type = "clamped"
[static]
report = ["tip"]
[modes]
count = 5
"""
LINE = '[[load]]\ntype = "line"\ngroup = "tip"\nline_force = [0.0, 0.0, 30.0]\n'
GRAVITY = '[[load]]\ntype = "gravity"\nacceleration = [0.0, 0.0, -9.81]\n'
PRESSURE = '[[load]]\ntype = "pressure"\ngroup = "strip"\npressure = -1e3\n'
TENSION = '[[load]]\ntype = "line"\ngroup = "tip"\nline_force = [14e3, 0.0, 0.0]\n'

# Exact Mindlin and plane-stress frequencies of the disc of tests/data, held at its inner edge, Hz.
DISC_Hz = [542.5079495233] * 2 + [638.0761173813] + [794.519920463] * 2 + [1045.85339702]


def run(program, mpirun, ranks, folder, scene, command):
    (folder / "scene.toml").write_text(scene)
    (folder / "strip.geo").write_text(STRIP_GEO)
    return summary(program / "chladni", command, "scene.toml", cwd=folder, mpirun=mpirun, ranks=ranks)


def arrays(file):
    """The arrays of a .vtu file by their names."""
    found = {}
    for array in ElementTree.parse(file).getroot().iter("DataArray"):
        data = base64.b64decode(array.text.strip())
        size = int(np.frombuffer(data[:8], dtype=np.uint64)[0])
        assert size == len(data) - 8, f"{array.get('Name')}: {size} bytes, has {len(data) - 8}"
        kind = {"Float64": np.float64, "Int64": np.int64}[array.get("type")]
        values = np.frombuffer(data[8:], dtype=kind)
        found[array.get("Name")] = values.reshape(-1, int(array.get("NumberOfComponents", 1)))
    return found


def expect(name, value, exact, within):
    error = abs(value / exact - 1)
    print(f"{'ok' if error < within else 'FAILED':8}{name}: {value:.8g}, exact {exact:.8g}, error {error:.1e}")
    return error < within


def misplaced(picture):
    """How far the nodes of VTK's biquadratic cells are from where VTK expects them: on the middles of
    the edges 01, 12, 32, 03 and in the centre."""
    points, offsets = picture["points"], picture["offsets"][:, 0]
    quadrilaterals = np.flatnonzero(picture["types"][:, 0] == 70)
    assert quadrilaterals.size > 0
    nodes = picture["connectivity"][:, 0][offsets[quadrilaterals, None] + np.arange(-9, 0)]
    corners = points[nodes[:, :4]]
    middles = (corners + corners[:, [1, 2, 3, 0]]) / 2
    centres = corners.mean(axis=1)
    return max(np.abs(points[nodes[:, 4:8]] - middles).max(), np.abs(points[nodes[:, 8]] - centres).max())


def deflections():
    """Of the tip under each load, by Timoshenko's beam."""
    stiffness = YOUNG * WIDTH * THICKNESS**3 / 12
    shear = 5 / 6 * YOUNG / 2 * WIDTH * THICKNESS
    area = WIDTH * THICKNESS
    tip = 30.0 * WIDTH
    q = -DENSITY * area * 9.81
    p = -1e3 * WIDTH
    uniform = LENGTH**4 / (8 * stiffness) + LENGTH**2 / (2 * shear)
    return {
        LINE: (2, tip * (LENGTH**3 / (3 * stiffness) + LENGTH / shear)),
        GRAVITY: (2, q * uniform),
        PRESSURE: (2, p * uniform),
        TENSION: (0, 7e3 * LENGTH / (YOUNG * area)),
    }


def check_static(program, mpirun, ranks, folder):
    good = True
    for load, (component, exact) in deflections().items():
        summary = run(program, mpirun, ranks, folder, STRIP + load, "static")
        motions = np.array([node["motion"] for node in summary["motions"]["tip"]])
        # The strip's own solution for a beam's loads is a polynomial of degree 4 at most, which
        # elements of order 2 meet in their nodes up to the term of degree 4.
        name = f"{ranks} rank(s), {', '.join(load.splitlines()[1:3])}"
        good &= expect(name, motions[:, component].mean(), exact, 1e-3)
        picture = arrays(folder / "strip.static.vtu")
        largest = np.linalg.norm(picture["displacement"], axis=1).max()
        good &= expect("  the same in the picture", largest, summary["largest_displacement_m"], 1e-12)
        distance = misplaced(picture)
        print(f"{'ok' if distance < 1e-12 else 'FAILED':8}  nodes of the cells: {distance:.1e}")
        good &= distance < 1e-12
        if load == PRESSURE:
            good &= expect("  reaction", summary["reaction_N"][2], 1e3 * WIDTH * LENGTH, 1e-9)
    return good


def check_modes(program, mpirun, ranks, folder):
    scene = (Path(__file__).parents[1] / "data/coarse_disc.toml").read_text()
    begin, end = scene.index("[[coupling]]"), scene.index("[interface]")
    held = scene[:begin] + '[[support]]\ngroup = "inner_edge"\ntype = "clamped"\n[modes]\ncount = 6\n'
    summary = run(program, mpirun, ranks, folder, held, "modes")
    # 12 elements around and 4 across, of order 3: 1e-4 was measured on meshes of that density.
    good = all([
        expect(f"{ranks} rank(s), mode {i + 1}", f, exact, 5e-4)
        for i, (f, exact) in enumerate(zip(summary["frequencies_Hz"], DISC_Hz))
    ])  # fmt: skip
    picture = arrays(folder / "disc.modes.vtu")
    inner = np.linalg.norm(picture["points"][:, :2], axis=1) < 0.0251
    still = np.abs(picture["mode 001 displacement"][inner]).max()
    print(f"{'ok' if still == 0 else 'FAILED':8}  motion of the clamped edge: {still}")
    free = run(program, mpirun, ranks, folder, scene[:begin] + scene[begin:end] + "[modes]\ncount = 8\n", "modes")
    rigid = free["n_rigid"] == 6 and free["frequencies_Hz"][5] == 0 and free["frequencies_Hz"][6] > 500
    print(f"{'ok' if rigid else 'FAILED':8}  the free disc: {free['frequencies_Hz']}")
    return good and still == 0 and rigid


def offset_strip():
    """Tension along the mesh bends a strip whose mid-surface is o above it: w = N o L^2 / (2 E I)."""
    o = 0.03
    force = 14e3 * WIDTH
    stiffness = YOUNG * WIDTH * THICKNESS**3 / 12
    scene = STRIP.replace(f"thickness = {THICKNESS}", f"thickness = {THICKNESS}\noffset = {o}") + TENSION
    tip = force * LENGTH / (YOUNG * WIDTH * THICKNESS) + force * o * o * LENGTH / stiffness
    return scene, {0: tip, 2: force * o * LENGTH**2 / (2 * stiffness)}


def tapered_strip():
    """w = int (P s^2 / (E I) + P / (kappa G A)) ds, with s from the tip."""
    profile = '{ over = "x", at = [0.0, 2.0], values = [0.1, 0.05] }'
    force = 30.0 * WIDTH
    s = (np.arange(20000) + 0.5) * LENGTH / 20000
    t = 0.05 + 0.05 * s / LENGTH
    slope = force * s**2 / (YOUNG * WIDTH * t**3 / 12) + force / (5 / 6 * YOUNG / 2 * WIDTH * t)
    return STRIP.replace(f"thickness = {THICKNESS}", f"thickness = {profile}") + LINE, {2: slope.mean() * LENGTH}


def check_sections(program, mpirun, folder):
    good = True
    for name, (scene, exact) in {"offset": offset_strip(), "tapered": tapered_strip()}.items():
        summary = run(program, mpirun, 1, folder, scene, "static")
        motions = np.array([node["motion"] for node in summary["motions"]["tip"]]).mean(axis=0)
        for component, value in exact.items():
            good &= expect(f"{name} strip, {'xyz'[component]}", motions[component], value, 1e-3)
    return good


def check_average(program, mpirun, folder):
    """An average stiffens nothing, and moves as its group does."""
    scene = (Path(__file__).parents[1] / "data/coarse_disc.toml").read_text()
    begin = scene.index("[[coupling]]")
    average = '[[coupling]]\ntype = "averaging"\nname = "hub"\ngroup = "inner_edge"\n'
    support = '[[support]]\ngroup = "outer_edge"\ntype = "clamped"\n[modes]\ncount = 10\n'
    plain = run(program, mpirun, 1, folder, scene[:begin] + support, "modes")["frequencies_Hz"]
    good = True
    for ranks in (1, 3):
        found = run(program, mpirun, ranks, folder, scene[:begin] + average + support, "modes")
        error = np.abs(np.array(found["frequencies_Hz"]) / plain - 1).max()
        print(f"{'ok' if error < 1e-7 else 'FAILED':8}{ranks} rank(s), modes with an average: {error:.1e}")
        good &= error < 1e-7  # K holds sums of as many terms as the group has nodes
    pull = '[[load]]\ntype = "force"\ngroup = "hub"\nforce = [0.0, 0.0, 50.0]\n[static]\nreport = ["hub", "inner_edge"]\n'
    pulled = run(program, mpirun, 2, folder, scene[:begin] + average + support + pull, "static")["motions"]
    # A force on the average is an even traction on the edge, whose length here is that of its arcs.
    line = pull.replace('"force"', '"line"', 1).replace('"hub"\nforce', '"inner_edge"\nline_force').replace("50.0", f"{50 / (0.05 * np.pi)}")
    drawn = run(program, mpirun, 1, folder, scene[:begin] + support + line.replace('"hub", ', ""), "static")["motions"]
    edge, even = (np.array([node["motion"] for node in m["inner_edge"]])[:, 2] for m in (pulled, drawn))
    good &= expect("edge under a force on its average", edge.max(), even.max(), 1e-4)
    good &= expect("  the same at the node that moves least", edge.min(), even.min(), 1e-4)
    # It does the work of the traction: u_ref is the mean weighted with lengths.
    good &= expect("  the average itself", pulled["hub"][0]["motion"][2], even.mean(), 1e-3)
    # As an attachment: the reduced disc held at the average against the FE model held there.
    reduced = run(program, mpirun, 2, folder, scene.replace('"rigid"', '"averaging"'), "run")
    held = scene[:begin] + average + '[[support]]\ngroup = "hub"\ntype = "clamped"\n[modes]\ncount = 5\n'
    modes = run(program, mpirun, 1, folder, held, "modes")["frequencies_Hz"]
    # 20 fixed-interface modes of the scene leave 1e-4 in the first ones.
    return good & all([
        expect(f"reduced, held at the average, mode {i + 1}", reduced["frequencies_Hz"][i], f, 1e-3)
        for i, f in enumerate(modes)
    ])  # fmt: skip


# A disc with bell: frequencies of 3-D elasticity by nodal diameters, Hz.
BELL = """
name = "bell"
[mesh]
generator = "hat_disc"
inner_radius = 0.066
outer_radius = 0.162
wall_radius = 0.070
top_radius = 0.070
hub_radius = 0.035
height = 0.046
foot = 0.010
element_size = 0.02
[material.iron]
young = 9.15915e10
poisson = 0.3
density = 6300.0
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = 0.02
[[section]]
group = "wall"
type = "shell"
material = "iron"
thickness = 0.008
[[section]]
group = "flange"
type = "shell"
material = "iron"
thickness = 0.008
[[coupling]]
type = "link"
group = "wall_foot"
to = "wall_seat"
[[support]]
group = "hub_edge"
type = "clamped"
[modes]
count = 13
"""
BELL_Hz = {0: 615.4141, 1: 313.1089, 2: 931.2335, 3: 1749.8337, 4: 2886.8318}


def check_bell(program, mpirun, folder):
    f = run(program, mpirun, 2, folder, BELL, "modes")["frequencies_Hz"]
    shell = {1: f[0], 0: f[2], 2: f[4], 3: f[8], 4: f[11]}
    good = all([
        expect(f"bell, n = {n}", shell[n], BELL_Hz[n], 0.005) for n in (0, 2, 3, 4)
    ])  # fmt: skip
    # What a shell does not have at the corner of wall and flange.
    good &= expect("bell, n = 1", shell[1], BELL_Hz[1], 0.04)
    # The same by an offset of the ring, whose mesh is the face on which the wall stands.
    link = BELL[BELL.index("[[coupling]]") : BELL.index("[[support]]")]
    face = BELL.replace(link, "").replace("thickness = 0.02\n", "thickness = 0.02\noffset = -0.01\n")
    face = face.replace("foot = 0.010", "foot = 0.0").replace("height = 0.046", "height = 0.036")
    by_offset = run(program, mpirun, 2, folder, face, "modes")["frequencies_Hz"]
    difference = np.abs(np.array(by_offset) / f - 1).max()
    print(f"{'ok' if difference < 1e-6 else 'FAILED':8}  an offset for the link: {difference:.1e}")
    return good and difference < 1e-6  # the wall's elements differ in height


def main(program, mpirun):
    results = []
    for ranks in (1, 2):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            results.append(check_static(program, mpirun, ranks, folder))
            results.append(check_modes(program, mpirun, ranks, folder))
    with tempfile.TemporaryDirectory() as name:
        for check in (check_sections, check_average, check_bell):
            results.append(check(program, mpirun, Path(name)))
    return all(results)


if __name__ == "__main__":
    sys.exit(not main(Path(sys.argv[1]), sys.argv[2]))
