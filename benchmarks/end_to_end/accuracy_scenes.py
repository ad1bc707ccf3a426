"""The geometries for which accuracy.py asks an accuracy, each with the finer mesh or the formula that judges it."""
import dataclasses
import math


@dataclasses.dataclass(frozen=True)
class Geometry:
    """A scene in parts. Where `exact` gives no frequencies, those of the mesh `fine` are the true ones."""
    mesh: str  # without element sizes
    model: str  # material, sections, couplings
    nodes: tuple  # of the interface
    fixed: tuple
    up_to_Hz: float
    fine: str = ""  # [mesh] of elements much smaller than an error of 1e-4 asks for
    files: dict = dataclasses.field(default_factory=dict)  # beside the scene
    exact: object = None  # the frequencies up to one, in Hz

    def beside(self, folder):
        for name, text in self.files.items():
            (folder / name).write_text(text)

    def scene(self, error):
        """That asks for an accuracy."""
        quoted = lambda names: "[" + ", ".join(f'"{name}"' for name in names) + "]"
        return (f'name = "body"\naccuracy = {{ error = {error!r}, up_to_Hz = {self.up_to_Hz!r} }}\n{self.mesh}{STEEL}{self.model}\n[interface]\n'
                f"nodes = {quoted(self.nodes)}\n\n[body]\nfixed = {quoted(self.fixed)}\n")

    def fine_scene(self, count):
        """Of the finer mesh, under the same support."""
        held = {}
        for name in self.fixed:
            group, _, component = name.partition(".")
            held.setdefault(group, []).extend([component] if component else ["x", "y", "z", "rx", "ry", "rz"])
        supports = "".join(f'\n[[support]]\ngroup = "{group}"\ndofs = [' + ", ".join(f'"{c}"' for c in dofs) + "]\n" for group, dofs in held.items())
        return f'name = "fine"\n{self.fine}{STEEL}{self.model}{supports}\n[modes]\ncount = {count}\n'


STEEL = """
[material.steel]
young = 2.1e11
poisson = 0.3
density = 7800.0
"""


def shell(group, thickness, material="steel", more=""):
    return f'\n[[section]]\ngroup = "{group}"\ntype = "shell"\nmaterial = "{material}"\nthickness = {thickness}\n{more}'


def beam(group, side, orientation, more=""):
    """Of a square cross-section."""
    area, inertia = side**2, side**4 / 12
    return (f'\n[[section]]\ngroup = "{group}"\ntype = "beam"\nmaterial = "steel"\narea = {area!r}\nI_y = {inertia!r}\n'
            f'I_z = {inertia!r}\nJ = {0.1406 * side**4!r}\norientation = {orientation}\n{more}')


def coupling(name, group):
    return f'\n[[coupling]]\ntype = "rigid"\nname = "{name}"\ngroup = "{group}"\n'


def annulus(inner, outer, *more):
    return "\n".join(["", "[mesh]", 'generator = "annulus"', f"inner_radius = {inner}", f"outer_radius = {outer}", 'pattern = "structured"', *more, ""])


def rectangle(length, width, *more):
    return "\n".join(["", "[mesh]", 'generator = "rectangle"', f"length = {length}", f"width = {width}", *more, ""])


def file_mesh(name, *more):
    return "\n".join(["", "[mesh]", f'file = "{name}"', *more, ""])


def fine(size, row=None):
    """Lines of elements of order 4 of a size, with rows along the edges."""
    return ["element_order = 4", f"element_size = {size}", *([f"edge_row = {row}"] if row else [])]


def cantilever_Hz(up_to_Hz):
    """Of a beam of Bernoulli and Euler in two planes, without rotary inertia; and along and about its axis."""
    length, side, young, density = 0.5, 0.02, 2.1e11, 7800.0
    shear, area, inertia = young / 2.6, side**2, side**4 / 12
    roots = [1.8751040687119611, 4.694091132974175, 7.854757438237613, 10.995540734875467, 14.13716839104647]
    roots += [(n - 0.5) * math.pi for n in range(6, 20)]
    bending = [r**2 / length**2 * math.sqrt(young * inertia / density / area) for r in roots]
    twist = math.sqrt(shear * 0.1406 * side**4 / (density * 2 * inertia))
    along = [(n + 0.5) * math.pi / length * c for n in range(10) for c in (math.sqrt(young / density), twist)]
    return sorted(f for f in (w / (2 * math.pi) for w in 2 * bending + along) if f <= up_to_Hz)


TRACK = 'rings = [{ name = "track", radius = 0.13, nodes = 24 }]'
THIN_TRACK = TRACK.replace("0.13", "0.16")
FOLDED = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 0.2, 0.12};
Rectangle(2) = {0, 0, 0, 0.15, 0.12}; Rotate {{0, 1, 0}, {0, 0, 0}, -Pi / 2} { Surface{2}; }
Coherence;
MeshSize{ PointsOf{ Surface{:}; } } = 0.04;
Physical Surface("plate") = {1, 2};
e() = Curve In BoundingBox{0.199, -1, -1, 0.201, 1, 1}; Physical Curve("edge") = {e()};
p() = Point In BoundingBox{-0.001, -0.001, 0.149, 0.001, 0.001, 0.151}; Physical Point("tip") = {p()};
"""
HOLE = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 0.3, 0.2};
Disk(2) = {0.1, 0.1, 0, 0.02};
BooleanDifference(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
MeshSize{ PointsOf{ Surface{:}; } } = 0.05;
Physical Surface("plate") = {3};
e() = Curve In BoundingBox{-0.001, -1, -1, 0.001, 1, 1}; Physical Curve("edge") = {e()};
p() = Point In BoundingBox{0.299, -0.001, -1, 0.301, 0.001, 1}; Physical Point("corner") = {p()};
"""
TWO = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 0.12, 0.16}; Rectangle(2) = {0.12, 0, 0, 0.18, 0.16};
Coherence;
MeshSize{ PointsOf{ Surface{:}; } } = 0.04;
Physical Surface("thick") = {1}; Physical Surface("thin") = {2};
e() = Curve In BoundingBox{-0.001, -1, -1, 0.001, 1, 1}; Physical Curve("edge") = {e()};
"""
CYLINDER = """h = 0.05;
SetFactory("OpenCASCADE"); Circle(1) = {0, 0, 0, 0.11}; e() = Extrude{0, 0, 0.27}{ Curve{1}; };
Physical Surface("wall") = {e(1)}; l() = Curve In BoundingBox{-1, -1, -0.001, 1, 1, 0.001}; Physical Curve("bottom") = {l()};
Mesh.MeshSizeMax = h; Mesh.RecombineAll = 1;
"""
RIBBED = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 0.3, 0.1}; Rectangle(2) = {0, 0.1, 0, 0.3, 0.1};
Coherence;
MeshSize{ PointsOf{ Surface{:}; } } = 0.04;
Physical Surface("plate") = {1, 2};
r() = Curve In BoundingBox{-1, 0.099, -1, 1, 0.101, 1}; Physical Curve("rib") = {r()};
e() = Curve In BoundingBox{-0.001, -1, -1, 0.001, 1, 1}; Physical Curve("edge") = {e()};
p() = Point In BoundingBox{0.299, -0.001, -1, 0.301, 0.001, 1}; Physical Point("corner") = {p()};
"""
FRAME = """h = 0.1; Point(1) = {0, 0, 0, h}; Point(2) = {0, 0, 0.4, h}; Point(3) = {0.6, 0, 0.4, h}; Point(4) = {0.6, 0, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4};
Physical Curve("frame") = {1, 2, 3};
Physical Point("feet") = {1, 4}; Physical Point("knee") = {2};
"""


PLATE = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 0.3, 0.2};
MeshSize{ PointsOf{ Surface{:}; } } = 0.01;
Physical Surface("plate") = {1};
e() = Curve In BoundingBox{-0.001, -1, -1, 0.001, 1, 1}; Physical Curve("edge") = {e()};
"""


def plate_msh(nx, ny, length=0.3, width=0.2):
    """Quadrilaterals of order 1 with the groups plate and edge, as text of MSH 2.2."""
    nodes = [(length * i / nx, width * j / ny) for j in range(ny + 1) for i in range(nx + 1)]
    corner = lambda i, j: (nx + 1) * j + i + 1
    quads = [(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)) for j in range(ny) for i in range(nx)]
    lines = [(corner(0, j), corner(0, j + 1)) for j in range(ny)]
    elements = [f"3 2 1 1 {' '.join(map(str, q))}" for q in quads] + [f"1 2 2 2 {a} {b}" for a, b in lines]
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '2 1 "plate"', '1 2 "edge"', "$EndPhysicalNames",
                      "$Nodes", str(len(nodes)), *(f"{k + 1} {x!r} {y!r} 0" for k, (x, y) in enumerate(nodes)), "$EndNodes",
                      "$Elements", str(len(elements)), *(f"{k + 1} {e}" for k, e in enumerate(elements)), "$EndElements", ""])


def plate_bdf(nx, ny, length=0.3, width=0.2):
    """The same plate as a deck of Nastran."""
    corner = lambda i, j: (nx + 1) * j + i + 1
    lines = ["SOL 103", "CEND", "SPC = 1", "BEGIN BULK", "MAT1,1,2.1+11,,0.3,7800.", "PSHELL,1,1,0.004,1,,1"]
    lines += [f"GRID,{corner(i, j)},,{length * i / nx:.6f},{width * j / ny:.6f},0." for j in range(ny + 1) for i in range(nx + 1)]
    lines += [f"CQUAD4,{nx * j + i + 1},1,{corner(i, j)},{corner(i + 1, j)},{corner(i + 1, j + 1)},{corner(i, j + 1)}"
              for j in range(ny) for i in range(nx)]
    lines += [f"SPC1,1,123456,{corner(0, j)}" for j in range(ny + 1)]
    return "\n".join([*lines, "ENDDATA", ""])


EDGES = ("left", "right", "bottom", "top")
HAT = ["", "[mesh]", 'generator = "hat_disc"', "outer_radius = 0.15", "wall_radius = 0.08", "hub_radius = 0.035", "height = 0.04", TRACK]
PAD = ["", "[mesh]", 'generator = "pad"', "inner_radius = 0.09", "outer_radius = 0.15", "angle_deg = 50"]
HUB = coupling("hub", "inner_edge")
SPRINGS = ('\n[[spring]]\nat = "corners"\nstiffness = { x = 1e6, y = 1e6, z = 1e6 }\n'
           '\n[[mass]]\nat = "corners"\nmass = 0.1\n')


def disc(name, *more, thickness=0.02, radii=(0.025, 0.162)):
    return {"mesh": annulus(*radii, *more), "model": shell("disc", thickness) + (HUB if name else "")}


def of_geo(name, text, size, *more):
    """The mesh of a .geo, and that of the same file with smaller elements."""
    assert text.count(size) == 1
    smaller = text.replace(size, f"{float(size) / 6}")
    return {"mesh": file_mesh(f"{name}.geo", *more), "fine": file_mesh(f"fine_{name}.geo", *more, "element_order = 3"),
            "files": {f"{name}.geo": text, f"fine_{name}.geo": smaller}}


GEOMETRIES = {
    "disc on a hub": Geometry(**disc("hub", TRACK), nodes=("track", "hub"), fixed=("hub",), up_to_Hz=6000.0,
                              fine=annulus(0.025, 0.162, *fine(0.012, 0.01))),
    "thin disc on a hub": Geometry(**disc("hub", THIN_TRACK, thickness=0.001, radii=(0.1, 0.2)), nodes=("track", "hub"), fixed=("hub",), up_to_Hz=640.0,
                                   fine=annulus(0.1, 0.2, *fine(0.01, 0.001))),
    "disc, edge supported": Geometry(**disc("", thickness=0.004, radii=(0.1, 0.2)), nodes=("inner_edge",),
                                     fixed=("inner_edge.x", "inner_edge.y", "inner_edge.z"), up_to_Hz=2000.0, fine=annulus(0.1, 0.2, *fine(0.01, 0.004))),
    "disc, edge clamped": Geometry(**disc("", thickness=0.004, radii=(0.1, 0.2)), nodes=("inner_edge",), fixed=("inner_edge",), up_to_Hz=2000.0,
                                   fine=annulus(0.1, 0.2, *fine(0.01, 0.004))),
    "one of twelve sectors": Geometry(**disc("", TRACK, "sectors = 12"), nodes=("track", "inner_edge"), fixed=("inner_edge",), up_to_Hz=6000.0,
                                      fine=annulus(0.025, 0.162, *fine(0.012, 0.01))),
    "hat disc": Geometry(mesh="\n".join([*HAT, ""]), fine="\n".join([*HAT, *fine(0.011), ""]), nodes=("track", "hub"), fixed=("hub",), up_to_Hz=5000.0,
                         model=shell("disc", 0.02) + shell("wall", 0.01) + shell("flange", 0.01) + coupling("hub", "hub_edge")),
    "pad": Geometry(mesh="\n".join([*PAD, ""]), fine="\n".join([*PAD, *fine(0.006, 0.003), ""]), model=shell("pad", 0.006), nodes=("corners",), fixed=(),
                    up_to_Hz=8000.0),
    "free plate": Geometry(mesh=rectangle(0.3, 0.2), fine=rectangle(0.3, 0.2, *fine(0.012, 0.005)), model=shell("plate", 0.006), nodes=("corners",),
                           fixed=(), up_to_Hz=4000.0),
    "cantilever plate": Geometry(mesh=rectangle(0.3, 0.16), fine=rectangle(0.3, 0.16, *fine(0.005, 0.0025)), model=shell("plate", 0.004), nodes=("left",),
                                 fixed=("left",), up_to_Hz=2000.0),
    "plate on four edges": Geometry(mesh=rectangle(0.3, 0.2), fine=rectangle(0.3, 0.2, *fine(0.012, 0.004)), model=shell("plate", 0.004), nodes=EDGES,
                                    fixed=tuple(f"{edge}.{c}" for edge in EDGES for c in "xyz"), up_to_Hz=4000.0),
    "plate, edges loaded": Geometry(mesh=rectangle(0.3, 0.2), fine=rectangle(0.3, 0.2, *fine(0.012, 0.005)), model=shell("plate", 0.006), nodes=EDGES,
                                    fixed=(), up_to_Hz=3000.0),
    "plate on springs": Geometry(mesh=rectangle(0.3, 0.2), fine=rectangle(0.3, 0.2, *fine(0.012, 0.005)), nodes=("corners",), fixed=(),
                                 model=shell("plate", 0.006) + SPRINGS, up_to_Hz=3000.0),
    "folded plate": Geometry(**of_geo("plate", FOLDED, "0.04"), model=shell("plate", 0.003), nodes=("edge", "tip"), fixed=("edge",), up_to_Hz=1500.0),
    "plate with a hole": Geometry(**of_geo("plate", HOLE, "0.05"), model=shell("plate", 0.006), nodes=("edge", "corner"), fixed=("edge",), up_to_Hz=2500.0),
    "two thicknesses": Geometry(**of_geo("plate", TWO, "0.04"), model=shell("thick", 0.008) + shell("thin", 0.003), nodes=("edge",), fixed=("edge",),
                                up_to_Hz=2500.0),
    "cylinder": Geometry(**of_geo("wall", CYLINDER, "0.05"), model=shell("wall", 0.003), nodes=("bottom",), fixed=("bottom",), up_to_Hz=2000.0),
    "plate with a rib": Geometry(**of_geo("plate", RIBBED, "0.04"), model=shell("plate", 0.004) + beam("rib", 0.012, [0, 0, 1]), nodes=("edge", "corner"),
                                 fixed=("edge",), up_to_Hz=1500.0),
    "cantilever beam": Geometry(mesh='\n[mesh]\ngenerator = "beam"\nstart = [0, 0, 0]\nend = [0.5, 0, 0]\n', nodes=("start", "end"), fixed=("start",),
                                model=beam("beam", 0.02, [0, 0, 1], 'theory = "bernoulli-euler"\nrotary_inertia = "none"\n'), up_to_Hz=4000.0,
                                exact=cantilever_Hz),
    "frame": Geometry(**of_geo("frame", FRAME, "0.1"), model=beam("frame", 0.02, [0, 1, 0]), nodes=("feet", "knee"), fixed=("feet",), up_to_Hz=1500.0),
    "plate of a .msh": Geometry(mesh=file_mesh("plate.msh"), files={"plate.msh": plate_msh(6, 4), "fine.geo": PLATE},
                                model=shell("plate", 0.004), nodes=("edge",), fixed=("edge",), up_to_Hz=1500.0,
                                fine=file_mesh("fine.geo", "element_order = 3")),
    "plate of a deck": Geometry(mesh=file_mesh("plate.bdf", 'length_unit = "m"'), model=shell("pshell_1", 0.004), nodes=("spc_1_123456",),
                                files={"plate.bdf": plate_bdf(6, 4), "fine.geo": PLATE.replace('"plate"', '"pshell_1"').replace('"edge"', '"spc_1_123456"')},
                                fixed=("spc_1_123456",), up_to_Hz=1500.0, fine=file_mesh("fine.geo", "element_order = 3")),
    "solid plate": Geometry(mesh=rectangle(0.3, 0.2, "extrude = { from = 0.0, to = 0.02, layers = 1 }"), nodes=("left",), fixed=("left",), up_to_Hz=4000.0,
                            fine=rectangle(0.3, 0.2, "extrude = { from = 0.0, to = 0.02, layers = 3 }", "element_order = 3", "element_size = 0.01"), model='\n[[section]]\ngroup = "plate"\ntype = "solid"\nmaterial = "steel"\n'),
}
