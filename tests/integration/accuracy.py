"""A scene that says an accuracy and no mesh gets one that keeps it.

The clamped annular Mindlin plate against its exact frequencies, for three accuracies; a free plate, a plate
from a .geo, a hat disc and a beam against meshes that were chosen for a tenth of the error. The elements of a
mesh file are split, and refused with the error that they have where the scene names their numbers.

Usage: accuracy.py PROGRAM_DIR
"""

import json
import math
import re
import sys
import tempfile
from pathlib import Path

from running import run, summary

UP_TO_HZ = 4000.0
OF_MODELS_HZ = 2000.0
# Hz, as in mesh_errors.py.
EXACT = sorted([638.0761173813, 1045.85339702, 3527.579164383]
               + 2 * [542.5079495233, 794.5199204630, 1672.090697922, 2854.918331051, 3315.46219397,
                      3799.055572333])
IRON = """
[material.iron]
young = 9.15915e10
poisson = 0.3
density = 6300.0
"""
HELD = """
[[support]]
group = "{group}"
dofs = ["x", "y", "z", "rx", "ry", "rz"]
"""
GEO = """
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 0.3, 0.2};
Disk(2) = {0.1, 0.1, 0, 0.02};
BooleanDifference(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
MeshSize{ PointsOf{ Surface{:}; } } = 0.05;
Physical Surface("plate") = {3};
Physical Curve("edge") = {Boundary{ Surface{3}; }};
"""


def shell(group, thickness):
    return f"""
[[section]]
group = "{group}"
type = "shell"
material = "iron"
thickness = {thickness}
"""


ANNULUS = ("""
[mesh]
generator = "annulus"
inner_radius = 0.025
outer_radius = 0.162
""" + IRON + shell("disc", 0.02) + HELD.format(group="inner_edge"))

MODELS = {
    "free plate": """
[mesh]
generator = "rectangle"
length = 0.3
width = 0.2
""" + IRON + shell("plate", 0.006),
    "plate of a .geo": """
[mesh]
file = "plate.geo"
""" + IRON + shell("plate", 0.006) + HELD.format(group="edge"),
    "hat disc": """
[mesh]
generator = "hat_disc"
outer_radius = 0.15
wall_radius = 0.08
hub_radius = 0.035
height = 0.04
""" + IRON + shell("disc", 0.02) + shell("wall", 0.01) + shell("flange", 0.01) + HELD.format(group="hub_edge"),
    "beam": """
[mesh]
generator = "beam"
start = [0, 0, 0]
end = [0.5, 0, 0]
""" + IRON + """
[[section]]
group = "beam"
type = "beam"
material = "iron"
area = 6e-4
I_y = 4.5e-8
I_z = 2e-8
J = 4.7e-8
orientation = [0, 0, 1]
""" + HELD.format(group="start"),
}


def frequencies(programs, folder, model, error, count, up_to_Hz=UP_TO_HZ):
    text = f"accuracy = {{ error = {error}, up_to_Hz = {up_to_Hz} }}\n{model}\n[modes]\ncount = {count}\n"
    (folder / "scene.toml").write_text(text)
    found = summary(programs / "chladni", "modes", folder / "scene.toml", "--output", folder)
    return [f for f in found["frequencies_Hz"] if 1.0 < f < up_to_Hz], found["n_dofs"]


def check(name, found, exact, error, n_dofs):
    worst = max(abs(f / e - 1) for f, e in zip(found, exact))
    print(f"{name:18} {error:9.0e} {worst:9.1e} {n_dofs:7}")
    return worst <= error and len(found) == len(exact)


def grid(n):
    """Nodes and elements of order 1, n by n."""
    across = range(n + 1)
    return [(0.3 * i / n, 0.2 * j / n) for j in across for i in across], [
        (c, c + 1, c + n + 2, c + n + 1) for c in ((n + 1) * j + i + 1 for j in range(n) for i in range(n))]  # fmt: skip


def plate_msh(n, points):
    """With groups of points, the numbers of whose nodes are given."""
    nodes, corners = grid(n)
    marked = [(k, node) for k, of in enumerate(points.values(), 2) for node in of]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(1 + len(points)), '2 1 "plate"',
             *(f'0 {k} "{name}"' for k, name in enumerate(points, 2)), "$EndPhysicalNames",
             "$Nodes", str(len(nodes)), *(f"{k + 1} {x} {y} 0" for k, (x, y) in enumerate(nodes)), "$EndNodes",
             "$Elements", str(len(corners) + len(marked)),
             *(f"{k} 3 2 1 1 {' '.join(map(str, of))}" for k, of in enumerate(corners, 1)),
             *(f"{len(corners) + 1 + k} 15 2 {group} {node} {node}" for k, (group, node) in enumerate(marked)),
             "$EndElements", ""]  # fmt: skip
    return "\n".join(lines)


def plate_inp(n, sets):
    """As a deck of Abaqus, with sets of nodes."""
    nodes, corners = grid(n)
    lines = ["*Heading", "a plate", "*Node", *(f"{k}, {x}, {y}, 0." for k, (x, y) in enumerate(nodes, 1)), "*Element, type=S4R, elset=plate",
             *(f"{k}, {', '.join(map(str, of))}" for k, of in enumerate(corners, 1))]  # fmt: skip
    for name, of in sets.items():
        lines += [f"*Nset, nset={name}", ", ".join(map(str, of))]
    return "\n".join([*lines, ""])


def points_stay_points(programs, folder):
    """Two points at the ends of one edge are no edge, and a row of nodes of a deck is one, as a note tells."""
    n, pair = 3, (5, 6)
    files = {"pair.msh": plate_msh(n, {"pair": pair}), "two.msh": plate_msh(n, {"one": pair[:1], "other": pair[1:]}),
             "pair.inp": plate_inp(n, {"PAIR": pair, "ROW": (1, 5, 9, 13)})}  # fmt: skip
    held = {"pair.msh": ["pair"], "two.msh": ["one", "other"], "pair.inp": ["PAIR"]}
    found = {}
    for name, text in files.items():
        (folder / name).write_text(text)
        is_deck = name.endswith(".inp")
        supports = "".join(f'[[support]]\ngroup = "{group}"\ndofs = ["x", "y", "z"]\n' for group in held[name])
        (folder / "scene.toml").write_text(
            f'accuracy = {{ error = 0.03, up_to_Hz = 300 }}\n[mesh]\nfile = "{name}"\n' + 'length_unit = "m"\n' * is_deck
            + IRON + shell("PLATE" if is_deck else "plate", 0.006) + supports + "[modes]\ncount = 4\n")  # fmt: skip
        said = run(programs / "chladni", "modes", folder / "scene.toml", "--output", folder, "--overwrite", "--json", folder / "found.json")
        found[name] = json.loads((folder / "found.json").read_text())["frequencies_Hz"]
        print(f"held in {name}: {', '.join(f'{f:.2f}' for f in found[name][:4])} Hz")
        if ("taken as edges: ROW;" in said) != is_deck or "raised to order" not in said:
            print(said)
            return False
    return all(abs(f - g) <= 1e-6 * max(g, 1.0) for name in held for f, g in zip(found[name], found["two.msh"], strict=True))


def takes_mesh_file(programs, folder, exact):
    """The elements of a .msh are split where they are too large, unless their numbers are named: then what it has is said, and what may be asked for."""
    def said_to(error, n, code, command="modes", more="[modes]\ncount = 40\n", up_to_Hz=UP_TO_HZ, corners=(1,)):
        (folder / "plate.msh").write_text(plate_msh(n, {"corner": corners}))
        (folder / "scene.toml").write_text(
            f'accuracy = {{ error = {error!r}, up_to_Hz = {up_to_Hz} }}\n[mesh]\nfile = "plate.msh"\n{IRON}'
            f'{shell("plate", 0.006)}\n{more}')
        return run(programs / "chladni", command, folder / "scene.toml", "--output", folder, "--overwrite", "--json", folder / "found.json", code=code)

    said = said_to(1e-3, 3, 0)
    assert re.search(r"plate.msh raised to order 3.*estimated error of the mesh", said), said
    found = [f for f in json.loads((folder / "found.json").read_text())["frequencies_Hz"] if 1.0 < f < OF_MODELS_HZ]  # as `exact`
    good = check("plate of a .msh", found, exact, 1e-3, 0)
    # At a held point a frequency changes by the logarithm of the size and has no limit.
    held = '[[support]]\ngroup = "corner"\ndofs = ["x", "y", "z"]\n[modes]\ncount = 4\n'
    refused = said_to(1e-6, 1, 1, more=held, up_to_Hz=100.0, corners=(1, 2, 3))
    print(refused.strip())
    assert re.search(r"acts at single nodes of shells .* has no limit: each halving of the elements lowers a frequency by another \S+ of it", refused)
    numbers = '[interface]\nnodes = ["corner"]\n[reduce]\nresultants = ["plate"]\nresultant_elements = [1]\n'
    coarse, fine = said_to(1e-3, 3, 1, "reduce", numbers), said_to(1e-3, 24, 1, "reduce", numbers)
    print(coarse.strip(), fine.strip(), sep="\n")
    refusal = r"may have (\S+) of it, and that of \S+plate.msh has an error of (\S+) up to .*resultant_elements"
    assert re.search(refusal, coarse) and "or ask for" not in coarse, "no scene may ask for so little"
    # The accuracy that it names is kept; a unit of its last digit less is refused, with two numbers that differ.
    possible = float(re.search(r"or ask for (\S+)", fine)[1])
    said_to(possible, 24, 0, "reduce", numbers)
    again = re.search(refusal, said_to(possible - 10.0 ** (math.floor(math.log10(possible)) - 1), 24, 1, "reduce", numbers))
    return good and float(again[2]) > float(again[1])


BODY = """
[[coupling]]
type = "rigid"
name = "hub"
group = "inner_edge"
[interface]
nodes = ["hub", "track"]
[body]
fixed = ["hub"]
keep = { modes = 10 }
"""


def takes_a_sector(programs, folder):
    """A disc that repeats is reduced from one sector, unless the scene says otherwise or something would be lost."""
    good, found, said = True, {}, {}
    disc = ANNULUS.replace(HELD.format(group="inner_edge"), "").replace(
        "[mesh]", '[mesh]\nrings = [{ name = "track", radius = 0.13, nodes = 24 }]')
    for name, change, one_sector in (("sector", ("", ""), True), ("whole", ("[mesh]", "[mesh]\nsectors = 1"), False),
                                     ("forces", ("[interface]", '[reduce]\nresultants = ["disc"]\n[interface]'), False)):
        scene = f'name = "{name}"\naccuracy = {{ error = 1e-3, up_to_Hz = {UP_TO_HZ} }}\n{disc}{BODY}'.replace(*change)
        (folder / f"{name}.toml").write_text(scene)
        said[name] = run(programs / "chladni", "reduce", folder / f"{name}.toml", "--output", folder, "--json", folder / "found.json")
        found[name] = json.loads((folder / "found.json").read_text())
        print(f"{name}: reduced from one sector: {'reduced from one sector' in said[name]}, {found[name]['n_dofs']} DOFs")
        good &= ("reduced from one sector; sectors = 1 in [mesh] would" in said[name]) == one_sector
    ours, theirs = (found[name]["certified_frequencies_Hz"] for name in ("sector", "whole"))
    off = max(abs(a / b - 1) for a, b in zip(ours, theirs))
    print(f"of {len(ours)} and {len(theirs)} certified frequencies those of the sector are off by {off:.1e}")
    good &= "the element numbers of section forces would be lost" in said["forces"]
    return good and off < 1e-3 and found["sector"]["n_dofs"] == found["whole"]["n_dofs"] == found["forces"]["n_dofs"]


def main(programs):
    good = True
    print(f"{'model':18} {'accuracy':>9} {'error':>9} {'DOFs':>7}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "plate.geo").write_text(GEO)
        for error in (1e-2, 1e-3, 1e-4):
            found, n_dofs = frequencies(programs, folder, ANNULUS, error, 20)
            good &= check("annulus", found, EXACT, error, n_dofs)
        for model, text in MODELS.items():
            fine, _ = frequencies(programs, folder, text, 3e-4, 20, OF_MODELS_HZ)
            found, n_dofs = frequencies(programs, folder, text, 3e-3, 20, OF_MODELS_HZ)
            good &= check(model, found, fine, 3e-3, n_dofs)
            if model == "free plate":
                good &= takes_mesh_file(programs, folder, fine)
                good &= points_stay_points(programs, folder)
        good &= takes_a_sector(programs, folder)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
