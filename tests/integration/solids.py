"""Solids: exact frequencies, one mesh on several ranks, loads, refusals.

Usage: solids.py PROGRAM_DIR MPIRUN

The annulus: three-dimensional elasticity by Fourier series around and hp elements of degree 9 x 8 in the meridian,
which agree with degree 7 to 1e-9. The sphere: Lamb's equations, roots of spherical Bessel functions.
"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

from running import run, summary

# Hz, of the free annulus: n = 2, 0, 3, 1, 2 in its plane, 2; those of n > 0 stand twice.
ANNULUS = [736.9524731] * 2 + [1202.7887257] + [1760.0313898] * 2 + [2626.5887121] * 2
IN_PLANE = [4405.6022377] * 2 + [4540.0313354] * 2
# omega a / c_s of the sphere, nu = 0.3: torsion and spheroids of degree 2, five times each
SPHERE = [2.5011326204093964] * 5 + [2.6462170348716625] * 5

MATERIAL = """
[material.iron]
young = {young}
poisson = {poisson}
density = {density}

[[section]]
group = "{group}"
type = "solid"
material = "iron"

[modes]
count = {count}
"""
IRON = {"young": 110e9, "poisson": 0.27, "density": 7150.0}

GENERATED = """
[mesh]
generator = "annulus"
inner_radius = 0.035
outer_radius = 0.16
element_size = {size}
element_order = {order}
pattern = "{pattern}"
extrude = {{ from = -0.01, to = 0.01, layers = {layers} }}
"""

SPHERE_GEO = """
R = 0.05; h = 0.018; o = newp; Point(o) = {0,0,0,h};
Point(2) = {R,0,0,h}; Point(3) = {0,R,0,h}; Point(4) = {-R,0,0,h}; Point(5) = {0,-R,0,h}; Point(6) = {0,0,R,h}; Point(7) = {0,0,-R,h};
Circle(1) = {2,o,3}; Circle(2) = {3,o,4}; Circle(3) = {4,o,5}; Circle(4) = {5,o,2};
Circle(5) = {3,o,6}; Circle(6) = {6,o,5}; Circle(7) = {5,o,7}; Circle(8) = {7,o,3};
Circle(9) = {2,o,7}; Circle(10) = {7,o,4}; Circle(11) = {4,o,6}; Circle(12) = {6,o,2};
Curve Loop(1) = {2,8,-10}; Surface(1) = {1}; Curve Loop(2) = {10,3,7}; Surface(2) = {2};
Curve Loop(3) = {-8,-9,1}; Surface(3) = {3}; Curve Loop(4) = {-11,-2,5}; Surface(4) = {4};
Curve Loop(5) = {-5,-12,-1}; Surface(5) = {5}; Curve Loop(6) = {-3,11,6}; Surface(6) = {6};
Curve Loop(7) = {-7,4,9}; Surface(7) = {7}; Curve Loop(8) = {-4,12,-6}; Surface(8) = {8};
Surface Loop(1) = {1:8}; Volume(1) = {1};
Physical Volume("ball") = {1}; Physical Surface("skin") = {1:8};
"""


def frequencies(programs, folder, scene, mpirun=None, ranks=1):
    """Hz, of `chladni modes`."""
    (folder / "scene.toml").write_text(scene)
    run(programs / "chladni", "modes", folder / "scene.toml", "--output", folder, "--json", folder / "modes.json",
        "--overwrite", mpirun=mpirun, ranks=ranks)  # fmt: skip
    found = json.loads((folder / "modes.json").read_text())
    return found["n_rigid"], found["frequencies_Hz"]


def error(found, exact):
    """The largest relative error, each number beside the nearest of the other list."""
    return max(min(abs(f - e) / e for f in found) for e in exact)


def annulus(programs, folder, most, size, order, layers, pattern="structured", exact=ANNULUS):
    scene = 'name = "annulus"\n' + GENERATED.format(size=size, order=order, layers=layers, pattern=pattern)
    n_rigid, found = frequencies(programs, folder, scene + MATERIAL.format(group="disc", count=24, **IRON))
    off = error(found, exact)
    print(f"annulus, order {order}, {layers} layers, {pattern}: {off:.1e}")
    if n_rigid != 6:
        yield f"annulus of order {order}: {n_rigid} rigid motions"
    if not off < most:
        yield f"annulus of order {order}, {pattern}: error {off:.1e}, more than {most}"
    lowest = min(f for f in found if f > 1.0)
    if lowest < ANNULUS[0] * (1.0 - 1e-9) and order > 1:
        yield f"annulus of order {order}: conforming elements are above the exact frequencies, found {lowest}"


def sphere(programs, folder, mpirun):
    (folder / "sphere.geo").write_text(SPHERE_GEO)
    steel = {"young": 210e9, "poisson": 0.3, "density": 7850.0}
    scene = 'name = "sphere"\n[mesh]\nfile = "sphere.geo"\n' + MATERIAL.format(group="ball", count=16, **steel)
    shear_speed = math.sqrt(steel["young"] / (2.0 * 1.3) / steel["density"])
    exact = [x * shear_speed / 0.05 / (2.0 * math.pi) for x in SPHERE]
    n_rigid, found = frequencies(programs, folder, scene)
    off = error(found[n_rigid : n_rigid + 10], exact)
    print(f"sphere of tetrahedra: {off:.1e}")
    if n_rigid != 6 or not off < 2e-3:
        yield f"sphere: {n_rigid} rigid motions, error {off:.1e}"
    _, on_three = frequencies(programs, folder, scene, mpirun, 3)
    if not error(on_three[6:], found[6:]) < 1e-9:
        yield "sphere: other frequencies on three ranks"


def loads(programs, folder):
    """A block between three planes under an even pressure p shortens by p h / E."""
    scene = """name = "block"
[mesh]
generator = "rectangle"
length = 0.3
width = 0.2
element_size = 0.1
element_order = 2
extrude = { from = 0.0, to = 0.1, layers = 2 }

[material.iron]
young = 110e9
poisson = 0.27
density = 7150.0

[[section]]
group = "plate"
type = "solid"
material = "iron"

[[support]]
group = "bottom_face"
dofs = ["z"]

[[support]]
group = "left"
dofs = ["x"]

[[support]]
group = "bottom"
dofs = ["y"]

[[load]]
type = "pressure"
group = "top_face"
pressure = 1e6

[static]
report = ["top_face"]
"""
    (folder / "block.toml").write_text(scene)
    found = summary(programs / "chladni", "static", folder / "block.toml", "--output", folder)
    exact = -1e6 / 110e9 * 0.1
    moved = [node["motion"][2] for node in found["motions"]["top_face"]]
    if not max(abs(z - exact) for z in moved) < 1e-9 * abs(exact):
        yield f"block under pressure: the top moves by {min(moved)} to {max(moved)}, not {exact}"
    if not abs(found["reaction_N"][2] - 1e6 * 0.3 * 0.2) < 1e-6 * 6e4:
        yield f"block under pressure: reaction {found['reaction_N']}"


REFUSED = {
    'type = "solid"|type = "shell"\nthickness = 0.02': "`extrude` makes solids",
    '[modes]|[model]\ndofs = ["z", "rx", "ry"]\n[modes]': "no other DOF",
    "element_order = 2|element_order = 4": "hexahedra of order 1 to 3",
    'pattern = "structured"|pattern = "structured"\nsectors = 5': "sectors",
    "to = 0.01|to = -0.02": "from",
}


def refusals(programs, folder):
    scene = ('name = "annulus"\n' + GENERATED.format(size=0.06, order=2, layers=1, pattern="structured")
             + MATERIAL.format(group="disc", count=4, **IRON))  # fmt: skip
    for change, words in REFUSED.items():
        old, new = change.split("|")
        (folder / "scene.toml").write_text(scene.replace(old, new, 1))
        done = subprocess.run([programs / "chladni", "modes", folder / "scene.toml", "--output", folder],
                              capture_output=True, text=True)  # fmt: skip
        if done.returncode != 1 or words not in done.stderr or done.stderr.count("\n") > 3:
            yield f"refusal of {new!r}: code {done.returncode}, {done.stderr[-300:]!r}"


def no_volume(programs, folder):
    """A section of solids on the faces of a volume, and on a mesh of surfaces."""
    (folder / "sphere.geo").write_text(SPHERE_GEO.replace('Physical Volume("ball") = {1}; ', ""))
    scene = 'name = "sphere"\n[mesh]\nfile = "sphere.geo"\n' + MATERIAL.format(group="skin", count=4, **IRON)
    (folder / "scene.toml").write_text(scene)
    said = run(programs / "chladni", "modes", folder / "scene.toml", "--output", folder, code=1)
    if "has no solid elements" not in said:
        yield f"faces with a section of solids: {said!r}"


def example(programs, folder):
    """The solid disc with its hub held has the third pair of diameters of the shell of examples/thesis_disc to 2 %."""
    scene = Path(__file__).parents[2] / "examples/solid_disc/scene.toml"
    said = run(programs / "chladni", "mesh", scene, "--quality", "--output", folder)
    if "surface elements" in said:
        yield f"chladni mesh of solids speaks of what is for shells: {said}"
    run(programs / "chladni", "run", scene, "--output", folder)
    found = summary(programs / "squeal", "run", scene, "--output", folder)
    critical = found["critical_frequency_Hz"]
    print(f"examples/solid_disc: critical frequency {critical:.1f} Hz")
    if not 1.0 < critical / 1672.09 < 1.05:  # the pads stiffen it
        yield f"examples/solid_disc: critical frequency {critical}"


def failures(programs, mpirun, folder):
    yield from annulus(programs, folder, 6e-4, 0.0209, 3, 1)
    yield from annulus(programs, folder, 6e-4, 0.0209, 3, 1, exact=IN_PLANE)
    yield from annulus(programs, folder, 3e-3, 0.0209, 2, 2)
    yield from annulus(programs, folder, 2e-2, 0.0105, 1, 4)
    yield from annulus(programs, folder, 6e-3, 0.0209, 2, 2, "triangles")
    yield from sphere(programs, folder, mpirun)
    yield from loads(programs, folder)
    yield from refusals(programs, folder)
    yield from no_volume(programs, folder)
    yield from example(programs, folder)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        found = list(failures(Path(sys.argv[1]), sys.argv[2], Path(name)))
    print("\n".join(found) or "solids have the exact frequencies, and say what they have not")
    sys.exit(bool(found))
