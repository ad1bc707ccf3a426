"""Solids with rigid and averaging couplings, beams and shells: exact solutions, the same frequencies in any way, refusals.

Usage: solid_couplings.py PROGRAM_DIR MPIRUN

With nu = 0 a bar of solids between rigid faces has the solutions of beams: u = M L^2 / (2 E I), theta = M L / (E I) of a
moment M at its end, and the waves of a rod along itself, w L / c tan(w L / c) = m / M with a mass M at its end.
"""

import math
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
from running import changed, run, start, summary

E, RHO, SIDE, LENGTH = 2e11, 7850.0, 0.04, 0.4
I, AREA = SIDE**4 / 12.0, SIDE**2

LOADED = """
[[support]]
group = "root"
type = "clamped"

[[load]]
type = "force"
group = "end"
moment = [0.0, 100.0, 0.0]

[static]
report = ["end"]

[modes]
count = 8
"""
MATERIAL = f"""
[material.m]
young = {E}
poisson = 0.0
density = {RHO}
"""

BAR = (
    f"""name = "bar"
[mesh]
generator = "rectangle"
length = {LENGTH}
width = {SIDE}
element_size = 0.04
element_order = 3
extrude = {{ from = {-SIDE / 2}, to = {SIDE / 2} }}
"""
    + MATERIAL
    + f"""
[[section]]
group = "plate"
type = "solid"
material = "m"

[[coupling]]
name = "end"
group = "right"
type = "rigid"
at = [{LENGTH}, {SIDE / 2}, 0.0]
"""
    + LOADED.replace("root", "left")
)

# A block of solids that goes on as a beam, and one that goes on as a plate of the same section.
ROD_GEO = """
h = 0.02; L = 0.2;
Point(1) = {0,-h,-h}; Point(2) = {0,h,-h}; Point(3) = {0,h,h}; Point(4) = {0,-h,h};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1:4} = 2; Transfinite Surface {1}; Recombine Surface {1};
e[] = Extrude {L,0,0} { Surface{1}; Layers{6}; Recombine; };
Physical Volume("block") = {e[1]}; Physical Surface("root") = {1}; Physical Surface("face") = {e[0]};
Point(120) = {L,0,0}; Point(121) = {2*L,0,0}; Line(120) = {120,121}; Transfinite Curve {120} = 7;
Point(130) = {L,-h,0}; Point(131) = {L,h,0}; Line(130) = {130,131}; Transfinite Curve {130} = 3;
"""
SHAFT_GEO = """
Physical Curve("shaft") = {120}; Physical Point("foot") = {120}; Physical Point("tip") = {121};
"""
SHEET_GEO = """
s[] = Extrude {L,0,0} { Line{130}; Layers{4}; Recombine; };
Physical Surface("sheet") = {s[1]}; Physical Curve("foot") = {130}; Physical Curve("tip") = {s[0]};
"""
ROD = (
    """name = "rod"
[mesh]
file = "rod.geo"
"""
    + MATERIAL
    + """
[[section]]
group = "block"
type = "solid"
material = "m"

OTHER_SECTION

[[coupling]]
name = "joint"
group = "face"
type = "rigid"

[[coupling]]
group = "foot"
type = "rigid"
to = "joint"

[[coupling]]
name = "end"
group = "tip"
type = "rigid"
"""
    + LOADED
)
SHAFT = f"""[[section]]
group = "shaft"
type = "beam"
material = "m"
area = {AREA}
I_y = {I}
I_z = {I}
J = {2 * I}
"""
SHEET = f"""[[section]]
group = "sheet"
type = "shell"
material = "m"
thickness = {SIDE}
"""

DISC = """name = "disc"
[mesh]
generator = "annulus"
inner_radius = 0.025
outer_radius = 0.162
element_size = 0.03
extrude = { from = -0.01, to = 0.01 }
rings = [{ name = "upper", radius = 0.13, nodes = 12, z = 0.01 }, { name = "lower", radius = 0.13, nodes = 12, z = -0.01 }]

[material.iron]
young = 9.15915e10
poisson = 0.3
density = 6300.0

[[section]]
group = "disc"
type = "solid"
material = "iron"

[[coupling]]
name = "hub"
group = "inner_edge"
type = "rigid"

[modes]
count = 16
"""
REDUCED = """
[[mass]]
at = "hub"
mass = 2.0
inertia = [0.01, 0.01, 0.02]
offset = [0.0, 0.0, 0.05]

[[spring]]
at = "hub"
stiffness = { rx = 2e4, z = 1e6 }

[interface]
nodes = ["hub", "upper", "lower"]

[reduce]
METHOD

[body]
keep = { modes = 12 }
"""


def off(found, exact):
    return abs(found / exact - 1.0)


def static(programs, folder, scene):
    """u and theta of the node "end"."""
    (folder / "scene.toml").write_text(scene)
    found = summary(programs / "chladni", "static", folder / "scene.toml", "--output", folder, "--overwrite")
    (end,) = found["motions"]["end"]
    return end["motion"]


def modes(programs, folder, scene, **options):
    """Number of rigid motions, and the frequencies in Hz."""
    (folder / "scene.toml").write_text(scene)
    found = summary(programs / "chladni", "modes", folder / "scene.toml", "--output", folder, "--overwrite", **options)
    return found["n_rigid"], found["frequencies_Hz"]


def turned_by_moment(programs, folder, name, scene, side=SIDE):
    """The exact solution of a moment at the end; round-off of K u = f with a condition number of 1e6."""
    bending = E * side * SIDE**3 / 12.0
    motion = static(programs, folder, scene)
    errors = [off(motion[2], -100.0 * LENGTH**2 / 2.0 / bending), off(motion[4], 100.0 * LENGTH / bending)]
    print(f"{name}, moment at the end: {max(errors):.1e}")
    if not max(errors) < 1e-9:
        yield f"{name}: moment moves the end by {motion}"


def cantilever(programs, folder):
    moment = "moment = [0.0, 100.0, 0.0]"
    for order in 2, 3:
        bar = changed(BAR, ("element_order = 3", f"element_order = {order}"))
        yield from turned_by_moment(programs, folder, f"bar of order {order}", bar)
        yield from turned_by_moment(programs, folder, f"bar of order {order}, averaged face",
                                    changed(bar, ('type = "rigid"', 'type = "averaging"')))  # fmt: skip
        # Timoshenko with kappa = 5/6. Shear is 0.6 % of it, of which elements of order 2, that cannot warp by the cube of
        # the height, lack a sixth, and those of order 3 what the held faces take.
        motion = static(programs, folder, changed(bar, (moment, "force = [0.0, 0.0, 100.0]")))
        exact = 100.0 * LENGTH**3 / (3.0 * E * I) + 100.0 * LENGTH / (5.0 / 6.0 * E / 2.0 * AREA)
        print(f"bar of order {order}, force at the end: {off(motion[2], exact):.1e}")
        if not off(motion[2], exact) < (1.3e-3 if order == 2 else 1e-4):
            yield f"bar of order {order}: force moves the end by {motion[2]}, not {exact}"
    # At another point of the rigid face: the motion of a rigid body.
    away = static(programs, folder, changed(BAR, (f"at = [{LENGTH}, {SIDE / 2}, 0.0]", "at = [0.5, 0.1, 0.3]")))
    at_end = static(programs, folder, BAR)
    shift = [away[0] - at_end[0] - at_end[4] * 0.3, away[2] - at_end[2] + at_end[4] * 0.1, away[4] - at_end[4]]
    if not max(map(abs, shift)) < 1e-9 * at_end[4]:
        yield f"bar: the reference node away from the face is no part of a rigid body: {shift}"


def solved(f, low, high):
    while high - low > 1e-15 * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if f(middle) > 0.0 else (low, middle)
    return low


def end_mass(programs, folder):
    """A rigid body at the end of the bar: along it the waves of a rod, across it Timoshenko's beam without mass."""
    mass, inertia = 20.0, 0.3
    body = f'[[mass]]\nat = "end"\nmass = {mass}\ninertia = [{inertia}, {inertia}, {inertia}]\n[static]'
    _, found = modes(programs, folder, changed(BAR, ("[static]", body)))
    ratio = RHO * AREA * LENGTH / mass
    x = solved(lambda x: ratio - x * math.tan(x), 1e-3, 1.5)
    rod = x * math.sqrt(E / RHO) / LENGTH / (2.0 * math.pi)
    nearest = min(off(f, rod) for f in found)
    print(f"bar with a mass at its end, along it: {nearest:.1e}")
    if not nearest < 1e-9:
        yield f"bar with a mass: none of {found} Hz is {rod} Hz"
    light = changed(BAR, ("[static]", body), (f"density = {RHO}", "density = 1e-3"))
    n_rigid, found = modes(programs, folder, light)
    shear = 12.0 * E * I / (5.0 / 6.0 * E / 2.0 * AREA * LENGTH**2)
    k = E * I / LENGTH**3 / (1.0 + shear)
    k11, k12, k22 = 12.0 * k, -6.0 * k * LENGTH, (4.0 + shear) * k * LENGTH**2
    b, c = k11 / mass + k22 / inertia, (k11 * k22 - k12**2) / (mass * inertia)
    for square in (b - math.sqrt(b * b - 4.0 * c)) / 2.0, (b + math.sqrt(b * b - 4.0 * c)) / 2.0:
        exact = math.sqrt(square) / (2.0 * math.pi)
        nearest = sorted(off(f, exact) for f in found)[:2]  # bending about both axes
        print(f"light bar with a mass at its end, across it: {nearest[1]:.1e}")
        if n_rigid != 0 or not nearest[1] < 2e-3:  # shear is a fifth of the stiffness against a shift of the end
            yield f"light bar with a mass: none of {found} Hz is {exact} Hz"


def beside_beams_and_shells(programs, folder, mpirun):
    for name, geo, section, side in ("shaft", SHAFT_GEO, SHAFT, SIDE), ("sheet", SHEET_GEO, SHEET, SIDE):
        (folder / "rod.geo").write_text(ROD_GEO + geo)
        scene = changed(ROD, ("OTHER_SECTION", section))
        yield from turned_by_moment(programs, folder, f"solid with {name}", scene, side)
        _, found = modes(programs, folder, scene)
        rod = math.sqrt(E / RHO) / LENGTH / 4.0
        nearest = min(off(f, rod) for f in found)
        print(f"solid with {name}, along it: {nearest:.1e}")
        if not nearest < 2e-6:  # six quadratic elements in an eighth of a wave
            yield f"solid with {name}: none of {found} Hz is {rod} Hz"
        free = changed(scene, ('[[support]]\ngroup = "root"\ntype = "clamped"\n', ""))
        n_rigid, found = modes(programs, folder, free)
        if n_rigid != 6 or not found[6] > 1.0:
            yield f"solid with {name}: {n_rigid} rigid motions, {found}"
        n_rigid, on_three = modes(programs, folder, free, mpirun=mpirun, ranks=3)
        if n_rigid != 6 or not max(map(off, on_three[6:], found[6:])) < 1e-9:
            yield f"solid with {name}: {on_three} Hz on three ranks"
    averaged = changed(scene, ("[mesh]", '[mesh]\ncoincident_nodes = "keep"'), ('group = "face"\ntype = "rigid"', 'group = "face"\ntype = "averaging"'))
    yield from turned_by_moment(programs, folder, "solid with sheet at its mean", averaged)


def hub(programs, folder):
    """A clamped hub holds the bore; a free disc with a rigid bore is that of shells, whose own distance is 3e-3."""
    held = '[[support]]\ngroup = "{}"\ntype = "clamped"\n[modes]'
    _, by_hub = modes(programs, folder, changed(DISC, ("[modes]", held.format("hub"))))
    without = DISC[: DISC.index("[[coupling]]")] + held.format("inner_edge") + "\ncount = 16\n"
    _, by_nodes = modes(programs, folder, without)
    print(f"disc with a clamped hub and with a held bore: {max(map(off, by_hub, by_nodes)):.1e}")
    if not max(map(off, by_hub, by_nodes)) < 1e-10:
        yield f"disc: {by_hub} Hz with a clamped hub, {by_nodes} Hz with held nodes"
    shell = changed(DISC, ('type = "solid"', 'type = "shell"\nthickness = 0.02'),
                    ("extrude = { from = -0.01, to = 0.01 }\n", ""),
                    (', z = 0.01 }, { name = "lower", radius = 0.13, nodes = 12, z = -0.01 }', " }"))  # fmt: skip
    n_solid, of_solid = modes(programs, folder, DISC)
    n_shell, of_shell = modes(programs, folder, shell)
    apart = max(map(off, of_solid[6:14], of_shell[6:14]))
    print(f"free disc with a rigid bore, solids and shells: {apart:.1e}")
    if n_solid != 6 or n_shell != 6 or not apart < 1.2e-2:
        yield f"free disc with a rigid bore: {n_solid} and {n_shell} rigid motions, {of_solid} and {of_shell} Hz"


def reductions(programs, folder, mpirun):
    """Each reduction is the same on any number of ranks, and the most exact has the frequencies of the model."""
    scene = changed(DISC + REDUCED, ("element_size = 0.03", "element_size = 0.05"))
    free = changed(scene, ("METHOD", 'method = "guyan"'))
    _, of_model = modes(programs, folder, free)
    for method in "guyan", "craig-bampton", "mixed-interface", "rubin":
        words = f'method = "{method}"' + ("" if method == "guyan" else "\nmodes = 30")
        (folder / "scene.toml").write_text(changed(scene, ("METHOD", words)))
        found = []
        for ranks in 1, 3:
            found.append(summary(programs / "chladni", "run", folder / "scene.toml", "--output", folder / f"{method}{ranks}",
                                 mpirun=mpirun, ranks=ranks))  # fmt: skip
        first = found[0]["frequencies_Hz"]
        elastic = [f for f in first if f > 1.0]
        for other in found[1:]:
            apart = max(map(off, [f for f in other["frequencies_Hz"] if f > 1.0], elastic))
            if not apart < 1e-9:
                yield f"{method}: {apart:.1e} apart on several ranks"
        exact = [f for f in of_model if f > 1.0]
        error = max(map(off, elastic[:6], exact))
        print(f"disc with a hub, {method}: {error:.1e} from the model, {found[0]['n_rigid']} rigid motions")
        if found[0]["n_rigid"] != 4 or not error < (1e-1 if method == "guyan" else 1e-3):
            yield f"{method}: {found[0]['n_rigid']} rigid motions, {elastic[:6]} Hz, not {exact[:6]}"
    spring = '[[spring]]\nat = "hub"\nstiffness = { rx = 2e4, z = 1e6 }\n'
    spinning = changed(scene, (spring, ""), ("METHOD", 'method = "guyan"\nstiffening = ["spin"]'))
    (folder / "scene.toml").write_text(spinning)
    run(programs / "chladni", "run", folder / "scene.toml", "--output", folder / "spin", mpirun=mpirun, ranks=3)
    with h5py.File(folder / "spin/disc.reduced.h5") as file:
        K, second = file["stiffening/omega_zz"][()], file["mass_integrals/second_moment"][()]
        places, at = zip(file["masters/node"][()], file["masters/component"][()]), file["attachment/node_positions"][()]
    turn = np.array([[*np.cross([0.0, 0.0, 1.0], at[node]), 0.0, 0.0, 1.0][c] for node, c in places])
    # The work of the load on a rotation about z; K of the masters has the round-off of u = K^-1 f.
    if not off(turn @ K @ turn, second[0, 0] + second[1, 1]) < 1e-9:
        yield f"disc with a hub: K_sigma of a rotation is {turn @ K @ turn}, and not {second[0, 0] + second[1, 1]}"
    info = run(programs / "chladni", "info", folder / "guyan1/disc.body.h5")
    mass = 6300.0 * math.pi * (0.162**2 - 0.025**2) * 0.02 + 2.0
    told = [float(line.split()[1]) for line in info.splitlines() if line.startswith("mass ")]
    if not told or not off(told[0], mass) < 1e-5:  # of which six digits are printed
        yield f"disc with a hub: mass {told}, not {mass}"


def sectors(programs, folder):
    """One sector of a disc with a hub, or the whole mesh cut by the program, has the frequencies of the whole disc."""
    found = []
    for key in "", "sectors = 6\n", 'sectors = "auto"\n':
        scene = changed(DISC + REDUCED, ("[mesh]\n", "[mesh]\n" + key), ("METHOD", 'method = "rubin"\nmodes = 20'),
                        ("rx = 2e4", "rx = 2e4, ry = 2e4"))  # fmt: skip
        (folder / "scene.toml").write_text(scene)
        found.append(summary(programs / "chladni", "run", folder / "scene.toml", "--output", folder / f"s{len(found)}"))
    for sector in found[1:]:
        apart = max(map(off, sector["frequencies_Hz"][3:], found[0]["frequencies_Hz"][3:]))
        print(f"disc with a hub by sectors: {apart:.1e} from the whole, {sector['n_rigid']} rigid motions")
        if not apart < 1e-9 or sector["n_rigid"] != 3 or found[0]["n_rigid"] != 3:
            yield f"disc by sectors: {sector['frequencies_Hz']} Hz, whole {found[0]['frequencies_Hz']}"


# A sector of tetrahedra whose cut faces have other nodes.
UNLIKE_GEO = """
SetFactory("OpenCASCADE");
Point(1) = {0.03,0,0}; Point(2) = {0.16,0,0}; Point(3) = {0.16,0,0.02}; Point(4) = {0.03,0,0.02};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
e[] = Extrude { {0,0,1}, {0,0,0}, Pi/3 } { Surface{1}; };
MeshSize{ PointsOf{ Volume{:}; } } = 0.02; MeshSize{ PointsOf{ Surface{1}; } } = 0.011;
Physical Volume("block") = {e[1]};
"""


def refusals(programs, folder):
    on_nodes = changed(BAR, ('group = "end"\nmoment', 'group = "left"\nmoment'), ("clamped", "simply-supported"))
    for scene in BAR + '[[mass]]\nat = "top_face"\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n', on_nodes:
        (folder / "scene.toml").write_text(scene)
        done = start(programs / "chladni", "static", folder / "scene.toml", "--output", folder, "--overwrite")
        if done.returncode != 1 or "of a solid has no rotations" not in done.stderr or done.stderr.count("\n") > 3:
            yield f"refusal: code {done.returncode}, {done.stderr[-300:]!r}"
    (folder / "rod.geo").write_text(UNLIKE_GEO)
    scene = ROD[: ROD.index("OTHER_SECTION")].replace("[mesh]", "[mesh]\nsectors = 6")
    (folder / "scene.toml").write_text(scene)
    said = run(programs / "chladni", "mesh", folder / "scene.toml", "--output", folder, code=1)
    if "the cut faces do not match: node" not in said:
        yield f"sector with unlike cut faces: {said!r}"


def failures(programs, mpirun, folder):
    yield from cantilever(programs, folder)
    yield from end_mass(programs, folder)
    yield from beside_beams_and_shells(programs, folder, mpirun)
    yield from hub(programs, folder)
    yield from reductions(programs, folder, mpirun)
    yield from sectors(programs, folder)
    yield from refusals(programs, folder)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        found = list(failures(Path(sys.argv[1]), sys.argv[2], Path(name)))
    print("\n".join(found) or "solids hang at hubs, beams and shells as theory says")
    sys.exit(bool(found))
