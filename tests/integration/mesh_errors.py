"""Estimated errors of the mesh lie on the errors against exact frequencies.

Annular Mindlin plates, clamped inside, thick and thin, smooth and with the layer at the free edge, of
quadrilaterals and triangles; an L-shaped plate, whose modes have a singular corner, against a much finer
mesh; a beam of Timoshenko elements against a much finer one. All modes with an error above what their
references tell: the effectivity, estimate over error, lies between 0.5 and 3. Plates that something acts on at
single nodes, against a mesh with nodes a tenth of the thickness apart: there it is hardly below 1.

Usage: mesh_errors.py PROGRAM_DIR
"""

import sys
import tempfile
from pathlib import Path

from running import summary

# Hz; annular Reissner-Mindlin plate, shear factor 5/6, the thesis disc: flexural modes, Fourier series in
# the angle, and in-plane modes; pairs twice.
SINGLE = [638.0761173813, 1045.85339702, 3527.579164383]
PAIRS = [542.5079495233, 794.5199204630, 1672.090697922, 2854.918331051, 3315.46219397, 3799.055572333,
         4256.944135248, 4810.220705822, 5814.00453578, 5839.422496225]
THICK = sorted(SINGLE + 2 * PAIRS)
# Outer radius over thickness -> Hz, three nodal diameters, bending stiffness and mass per area of that disc.
THIN = {50: 1744.260759688, 100: 1747.463634387, 1000: 1749.563780449}
LEAST, MOST = 0.5, 3.0
LEAST_AT_POINTS = 0.95  # a search leaves a tenth of an accuracy
# Below, what the references lack decides: drilling stiffness, digits of in-plane frequencies.
SEEN = 2e-6

PLATE = """
[material.iron]
young = {young!r}
poisson = 0.3
density = {density!r}
[[section]]
group = "{group}"
type = "shell"
material = "iron"
thickness = {thickness!r}
[[support]]
group = "{support}"
dofs = ["x", "y", "z", "rx", "ry", "rz"]
[modes]
count = {count}
mesh_errors = {estimated}
"""

PLATE_WITH_HOLE = """
SetFactory("OpenCASCADE");
DefineConstant[ h = 0.1 ];
Rectangle(1) = {0, 0, 0, 0.3, 0.2};
Disk(2) = {0.1, 0.1, 0, 0.02};
BooleanDifference(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
MeshSize{ PointsOf{ Surface{:}; } } = h;
Physical Surface("plate") = {3};
Physical Curve("left") = {Boundary{ Surface{3}; }};
"""

L_SHAPE = """
SetFactory("OpenCASCADE");
DefineConstant[ h = 0.1 ];
Rectangle(1) = {0, 0, 0, 0.5, 1};
Rectangle(2) = {0.5, 0, 0, 0.5, 0.5};
Coherence;
MeshSize{ PointsOf{ Surface{:}; } } = h;
Physical Surface("plate") = {Surface{:}};
Physical Curve("edge") = {Boundary{ Surface{:}; }};
"""


def annulus(thickness, size, order=3, pattern="structured", row=None, count=24):
    return f"""
[mesh]
generator = "annulus"
inner_radius = 0.025
outer_radius = 0.162
element_order = {order}
element_size = {size}
pattern = "{pattern}"
{f"edge_row = {row!r}" if row else ""}
""" + PLATE.format(young=9.15915e10 * (0.02 / thickness) ** 3, density=6300.0 * 0.02 / thickness, group="disc",
                   thickness=thickness, support="inner_edge", count=count, estimated="true")


def of_geo(name, size, order, thickness, estimated):
    return f"""
[mesh]
file = "{name}"
element_order = {order}
parameters = {{ h = {size} }}
""" + PLATE.format(young=2e11, density=7800.0, group="plate", thickness=thickness, support="left", count=4,
                   estimated=estimated)


def beam(elements, estimated):
    return f"""
[mesh]
generator = "beam"
start = [0, 0, 0]
end = [1, 0, 0]
elements = {elements}
[material.steel]
young = 2e11
poisson = 0.3
density = 7800.0
[[section]]
group = "beam"
type = "beam"
material = "steel"
area = 6e-4
I_y = 4.5e-8
I_z = 2e-8
J = 4.7e-8
orientation = [0, 0, 1]
[[support]]
group = "start"
dofs = ["x", "y", "z", "rx", "ry", "rz"]
[modes]
count = 6
mesh_errors = {estimated}
"""


SPRINGS = """
[[spring]]
at = "corners"
stiffness = { x = 3e7, y = 3e7, z = 3e7 }
[[mass]]
at = "corners"
mass = 1.0
"""
HELD = """
[[support]]
group = "corners"
dofs = ["x", "y", "z"]
"""
THICKNESS = 0.02  # m, of what is acted on at points


def at_points(size, order, what, count, estimated):
    return f"""
[mesh]
generator = "rectangle"
length = 0.2
width = 0.15
element_order = {order}
element_size = {size!r}
[material.steel]
young = 2.1e11
poisson = 0.3
density = 7800.0
[[section]]
group = "plate"
type = "shell"
material = "steel"
thickness = {THICKNESS}
{what}
[modes]
count = {count}
mesh_errors = {estimated}
"""


def modes(programs, folder, text):
    (folder / "scene.toml").write_text(text)
    found = summary(programs / "chladni", "modes", folder / "scene.toml", "--output", folder)
    return found["frequencies_Hz"], found.get("errors_of_mesh")


def check(name, frequencies, exact, estimates, seen=SEEN, least=LEAST):
    """One line of the table; whether all effectivities are as they should be."""
    errors = [abs(f / e - 1) for f, e in zip(frequencies, exact)]
    ratios = [estimate / error for estimate, error in zip(estimates, errors) if error > seen]
    print(f"{name:44} {max(errors):9.1e} {min(ratios):6.2f} {max(ratios):6.2f}")
    return least <= min(ratios) and max(ratios) <= MOST


def main(programs):
    good = True
    print(f"{'model':44} {'error':>9} {'effectivity':>13}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for order, size, pattern in ((2, 0.03, "structured"), (3, 0.06, "structured"), (3, 0.03, "structured"),
                                     (3, 0.04, "triangles"), (4, 0.04, "unstructured")):
            found, estimates = modes(programs, folder, annulus(0.02, size, order, pattern))
            good &= check(f"thick, order {order}, {size} m, {pattern}", found, THICK, estimates)
        for ratio, exact in THIN.items():
            for row in (None, 0.162 / ratio):
                found, estimates = modes(programs, folder, annulus(0.162 / ratio, 0.03, row=row, count=12))
                nearest = min(range(len(found)), key=lambda k: abs(found[k] - exact))
                good &= check(f"r/h = {ratio}{', edge row' if row else ''}", [found[nearest]], [exact],
                              [estimates[nearest]])
        (folder / "l.geo").write_text(L_SHAPE.replace('"edge"', '"left"'))
        fine, _ = modes(programs, folder, of_geo("l.geo", 0.02, 3, 0.05, "false"))
        found, estimates = modes(programs, folder, of_geo("l.geo", 0.15, 2, 0.05, "true"))
        good &= check("L-shaped plate, clamped", found, fine, estimates, 1e-4)
        (folder / "hole.geo").write_text(PLATE_WITH_HOLE)
        fine, _ = modes(programs, folder, of_geo("hole.geo", 0.012, 3, 0.004, "false"))
        found, estimates = modes(programs, folder, of_geo("hole.geo", 0.025, 3, 0.004, "true"))
        good &= check("thin plate with a round hole, triangles", found, fine, estimates)
        fine, _ = modes(programs, folder, beam(400, "false"))
        found, estimates = modes(programs, folder, beam(10, "true"))
        good &= check("cantilever of ten Timoshenko elements", found, fine, estimates)
        # Higher modes go so far that they change places.
        for name, what, count in (("on springs, with masses", SPRINGS, 8), ("held", HELD, 4)):
            # Nodes of elements of order 4 are a quarter of their size apart.
            fine, _ = modes(programs, folder, at_points(0.4 * THICKNESS, 4, what, count, "false"))
            for order, size in ((2, 0.03), (3, 0.05), (4, 0.05)):
                found, estimates = modes(programs, folder, at_points(size, order, what, count, "true"))
                good &= check(f"plate {name} at its corners, order {order}, {size} m", found[-len(estimates):], fine[-len(estimates):],
                              estimates, 1e-4, LEAST_AT_POINTS)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
