"""A user's mistake ends with exit code 1 (2: wrong usage), one message that names it, and no file but a good
reduction.

Usage: bad_input.py PROGRAM_DIR
"""

import sys
import tempfile
from pathlib import Path

from running import start

GOOD = (Path(__file__).parents[1] / "data/coarse_disc.toml").read_text()

SQUEAL = """
[squeal]
ring = "track"
thickness = 0.02
speeds = { from_rad_s = 3.0, to_rad_s = 60.0, count = 5 }
friction = 0.6
pads = [{ angle_deg = 0.0, stiffness = 6e6, damping = 0.0, preload = 2000.0 }]
analyses = ["eigenvalues"]
"""

PLATE_GEO = """
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 0.2, 0.1};
Physical Surface("plate") = {1};
"""

# Element 12 is folded over at its node 6.
FOLDED_MSH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
6
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 2 0 0
6 1.2 0.2 0
$EndNodes
$Elements
2
11 3 2 1 1 1 2 3 4
12 3 2 1 1 2 5 6 3
$EndElements
"""
# One solid, and a quadrilateral whose group no section names beside one that has a section.
SOLID_MSH = FOLDED_MSH[: FOLDED_MSH.index("$Elements")] + "$Elements\n1\n1 4 2 1 1 1 2 3 6\n$EndElements\n"
TWO_GROUPS_MSH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
0 7 "loose"
2 1 "disc"
2 2 "spare"
$EndPhysicalNames
""" + (
    FOLDED_MSH[FOLDED_MSH.index("$Nodes") :]
    .replace("6 1.2 0.2 0", "6 2 1 0")
    .replace("12 3 2 1 1 ", "12 3 2 2 2 ")
)
LOOSE_MSH = (
    TWO_GROUPS_MSH.replace("12 3 2 2 2 ", "12 3 2 1 1 ")
    .replace("6\n1 0", "7\n1 0")
    .replace("$EndNodes", "7 9 9 0\n$EndNodes")
    .replace("$Elements\n2", "$Elements\n3\n10 15 2 7 7 7")
)
MESH_FILES = {
    "plate.geo": PLATE_GEO,
    "folded.msh": FOLDED_MSH,
    "cut_off.msh": FOLDED_MSH[:-30],
    "turned_back.msh": FOLDED_MSH.replace("5 2 0 0", "5 0.2 0 0").replace("6 1.2 0.2 0", "6 0.2 1 0"),
    "solid.msh": SOLID_MSH,
    "two_groups.msh": TWO_GROUPS_MSH,
    "loose.msh": LOOSE_MSH,
    "crack.msh": FOLDED_MSH.replace("6 1.2 0.2 0", "6 2 1 0")
    .replace("6\n1 0", "7\n1 0")
    .replace("$EndNodes", "7 1 1 0\n$EndNodes")
    .replace("2 5 6 3", "2 5 6 7"),
}


def changed(old, new):
    """The good scene with one mistake in it."""
    assert GOOD.count(old) == 1, f"{old!r} must stand once in the good scene"
    return GOOD.replace(old, new)


def with_mesh_file(name):
    """The good scene on a mesh from a file, without a ring."""
    annulus = GOOD[GOOD.index('generator = "annulus"') : GOOD.index("[material.iron]")]
    order = "element_order = 2" if name.endswith(".geo") else ""
    scene = changed(annulus, f'file = "{name}"\n{order}\n')
    return scene.replace('nodes = ["track", "hub"]', 'nodes = ["hub"]')


def without_hub(name):
    """The same without the coupling; the edge is named elsewhere only."""
    scene = with_mesh_file(name)
    scene = scene.replace(scene[scene.index("[[coupling]]") : scene.index("[interface]")], "")
    return scene.replace('["hub"]', '["disc"]')


LOOSE = '[[coupling]]\ntype = "rigid"\nname = "hub"\ngroup = "loose"\n[interface]'

# mistake, scene (None: no file), words of the message
SCENES = [
    ("missing scene file", None, ["scene.toml"]),
    ("no TOML", "title = = 1\n", ["scene.toml:1"]),
    ("missing mesh file", with_mesh_file("no_such.msh"), ["no_such.msh"]),
    ("folded element", with_mesh_file("folded.msh"), ["folded.msh", "1 elements", ": 12"]),
    ("element on its neighbour", with_mesh_file("turned_back.msh"), ["turned_back.msh", "lie on one another", "11 and 12"]),
    ("mesh file that is cut off", with_mesh_file("cut_off.msh"), ["cut_off.msh", "missing"]),
    ("coincident nodes", with_mesh_file("crack.msh"), ["crack.msh", "3 and 7", "merge"]),
    ("parameter that the geometry lacks",
     with_mesh_file("plate.geo").replace("element_order", "parameters = { r = 1.0 }\nelement_order"),
     ["plate.geo", "no parameter r"]),
    ("missing group in a mesh file", with_mesh_file("plate.geo"), ['section.group = "disc"', "plate"]),
    ("missing group", changed('group = "disc"', 'group = "disk"'), ["disk", "disc"]),
    ("brake disc that is free", changed('fixed = ["hub"]', "fixed = []") + SQUEAL, ["hub"]),
    ("brake disc held by one DOF", changed('["hub"]\nkeep', '["hub.z"]\nkeep') + SQUEAL, ["hub.z"]),
    ("nothing to hold it by", changed('nodes = ["track", "hub"]', "nodes = []"), ["interface"]),
    ("mistyped key", changed("thickness = 0.02", "thicknes = 0.02"), ["thicknes", "thickness"]),
    ("wrong type", changed("young = 9.15915e10", 'young = "soft"'), ["young", "soft"]),
    ("value without sense", changed("poisson = 0.3", "poisson = 0.6"), ["poisson", "0.6"]),
    ("zero thickness", changed("thickness = 0.02", "thickness = 0.0"), ["thickness", "0"]),
    ("formula that is none", changed("thickness = 0.02", 'thickness = "0.02 * raduis"'), ["raduis", "radius"]),
    ("comma for a point", changed("thickness = 0.02", 'thickness = "0,02"'), ["0,02", "point"]),
    ("comma in brackets", changed("thickness = 0.02", 'thickness = "2 * (0,01)"'), ["0,01", "point"]),
    ("comma among arguments", changed("thickness = 0.02", 'thickness = "max(0,02, 0.001 * x)"'),
     ["scene.toml:", "section.thickness", "max(0,02", "point"]),
    ("elements without size", changed("element_size = 0.03", "element_size = 1e-300"),
     ["scene.toml:", "element_size = 1e-300", "10 million"]),
    ("formula that is zero", changed("thickness = 0.02", 'thickness = "0.02 - 0.2 * x"'), ["disc", "node", "0.02 - 0.2 * x"]),
    ("mesh of solids", with_mesh_file("solid.msh"), ["solid.msh", "1 solid", "mid-surface"]),
    ("group without a section", without_hub("two_groups.msh"), ["element 12", "section"]),
    ("coupling of a free node", without_hub("loose.msh").replace("[interface]", LOOSE), ["loose"]),
    ("negative thickness", changed("thickness = 0.02", "thickness = -0.02"), ["thickness"]),
]
HELD = '[[support]]\ngroup = "outer_edge"\ntype = "clamped"\n'
LOADED = '[[load]]\ntype = "pressure"\ngroup = "disc"\npressure = 1e3\n[static]\n'
# mistake, scene, words of the message of `chladni static`
STATIC_SCENES = [
    ("nothing to hold the body", GOOD + LOADED, ["move freely", "6 ways", "[[support]]"]),
    ("held in one direction", GOOD + LOADED + HELD.replace('type = "clamped"', 'dofs = ["z"]'),
     ["3 ways", "translation along x", "rotation about z"]),
    ("no load", GOOD + HELD + "[static]\n", ["load", "missing"]),
    ("support of an unknown group", GOOD + LOADED + HELD.replace("outer_edge", "outer_egde"),
     ["outer_egde", "outer_edge"]),
    ("support of dependent nodes", GOOD + LOADED + HELD.replace("outer_edge", "inner_edge"),
     ["inner_edge", "hub"]),
    ("unknown group of a mesh file", with_mesh_file("plate.geo").replace('"disc"', '"plate"').replace("inner_edge", "plate")
     + '[static]\n[[load]]\ntype = "line"\ngroup = "rim"\nline_force = [0.0, 0.0, 1.0]\n', ["rim", "plate"]),
]  # fmt: skip
# program, arguments, exit code, words of the message
CALLS = [
    ("chladni", ["polish"], 2, ["subcommand"]),
    ("chladni", ["run"], 2, ["SCENE"]),
    ("chladni", ["run", "scene.toml", "--outptu", "out"], 2, ["--outptu"]),
    ("squeal", ["run", "scene.toml", "--outptu", "out"], 2, ["--outptu"]),
    ("squeal", ["run", "scene.toml", "--output", "out"], 1, ["body.h5", "chladni run"]),
]


# The reduction of these is good; it is not thrown away with the body.
KEPT_REDUCTION = ("brake disc that is free", "brake disc held by one DOF")


def left_behind(folder, name):
    expected = ["disc.reduced.h5"] if name in KEPT_REDUCTION else []
    left = sorted(path.name for path in (folder / "out").glob("*"))
    if left != expected:
        yield f"left behind: {left}"


def complaints(run, code, words):
    """What is wrong with the way a program took a mistake."""
    if run.returncode != code:
        yield f"exit code {run.returncode}, expected {code}"
    lines = [line for line in run.stderr.splitlines() if line.strip()]
    # One message and perhaps a hint; not PETSc's stack nor the bulletin of MPI_Abort.
    if not 1 <= len(lines) <= 2:
        yield f"{len(lines)} lines on stderr instead of one message"
    yield from (f"the message does not say '{word}'" for word in words if word not in run.stderr)


def passes(name, scene, command, code, words):
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        if scene is not None:
            (folder / "scene.toml").write_text(scene)
        for file, text in MESH_FILES.items():
            (folder / file).write_text(text)
        run = start(*command, cwd=folder, timeout=100)
        bad = [*complaints(run, code, words), *left_behind(folder, name)]
    print(f"{'FAILED' if bad else 'ok':8}{name}: {'; '.join(bad)}\n{run.stderr.rstrip()}\n")
    return not bad


def main(programs):
    results = [
        passes(name, scene, [programs / "chladni", "run", "scene.toml", "--output", "out"], 1, words)
        for name, scene, words in SCENES
    ]
    results += [
        passes(name, scene, [programs / "chladni", "static", "scene.toml", "--output", "out"], 1, words)
        for name, scene, words in STATIC_SCENES
    ]
    results += [
        passes(f"{program} {' '.join(arguments)}", GOOD + SQUEAL,
               [programs / program, *arguments], code, words)
        for program, arguments, code, words in CALLS
    ]  # fmt: skip
    return all(results)


if __name__ == "__main__":
    sys.exit(not main(Path(sys.argv[1])))
