"""One plate written in many ways has one set of frequencies: decks of Nastran and Abaqus, universal files and files of Gmsh,
renumbered, moved, mirrored, in millimetres, with groups in two, doubled elements, blanks, comments, continuations and included
files as other programs and people write them. What is refused must be named with file and line.

Usage: plate_many_ways.py PROGRAM_DIR [COUNT [SEED]]
"""

import random
import subprocess
import sys
import tempfile
from pathlib import Path

from running import run, start, summary

N_X, N_Y, STEP, THICKNESS = 6, 4, 0.2, 0.01  # m
YOUNG, POISSON, DENSITY = 2.07e11, 0.29, 7820.0
FIRST = [5.9607, 20.3066, 39.5107, 71.7693, 99.861, 128.6137]  # Hz, to the digits that are written
COUNT = 16


def small(value):
    """In eight columns."""
    for digits in range(7, 0, -1):
        text = f"{value:.{digits}g}"
        if "e" in text:
            mantissa, exponent = text.split("e")
            text = f"{mantissa if '.' in mantissa else mantissa + '.'}{int(exponent):+d}"
        elif "." not in text:
            text += "."
        if len(text) <= 8:
            return text
    raise ValueError(value)


class Plate:
    """Nodes and elements under the numbers, at the places and in the unit of one way to write them."""

    def __init__(self, rng):
        self.rng = rng
        self.metres = rng.choice((1.0, 1e-3))
        self.mirror = rng.choice((1, -1))
        self.axes = rng.choice(((0, 1, 2), (2, 0, 1), (1, 2, 0)))
        self.origin = [rng.choice((0.0, 1.6, -0.4)) for _ in range(3)]
        numbers = range(1, (N_X + 1) * (N_Y + 1) + 1)
        self.numbers = list(numbers) if rng.random() < 0.3 else rng.sample(range(1, 4000), len(numbers))
        self.nodes = {self.number(i, j): self.place(i, j) for j in range(N_Y + 1) for i in range(N_X + 1)}
        self.held = [self.number(0, j) for j in range(N_Y + 1)]
        rng.shuffle(self.held)
        labels = rng.sample(range(1, 900), N_X * N_Y)
        self.elements = [(label, self.corners(i, j), 1 + (i >= 3))
                         for label, (i, j) in zip(labels, ((i, j) for j in range(N_Y) for i in range(N_X)))]  # fmt: skip
        rng.shuffle(self.elements)

    def number(self, i, j):
        return self.numbers[i + j * (N_X + 1)]

    def place(self, i, j):
        plane = [self.mirror * STEP * i, STEP * j, 0.0]
        return [round((plane[axis] + shift) / self.metres, 9) for axis, shift in zip(self.axes, self.origin)]

    def corners(self, i, j):
        around = [self.number(i + a, j + b) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        if self.rng.random() < 0.2:
            around.reverse()
        first = self.rng.randrange(4)
        return around[first:] + around[:first]

    def stress(self):
        return YOUNG * self.metres**2

    def density(self):
        return DENSITY * self.metres**4

    def thickness(self):
        return THICKNESS / self.metres


class Nastran:
    """Cards in a style of their own each."""

    def __init__(self, plate):
        self.plate, self.rng = plate, plate.rng
        self.lines = []
        self.apart = []  # continuations that stand elsewhere
        self.n_marks = 0

    def card(self, name, *fields):
        fields = ["" if f is None else small(f) if isinstance(f, float) else str(f) for f in fields]
        style = self.rng.choice(("small", "small", "free", "large", "lower", "tabs"))
        if style in ("free", "lower"):
            rows = [fields[at : at + 8] for at in range(0, len(fields), 8)]
            gap = self.rng.choice(("", " "))
            text = [f",{gap}".join(["" if k else name, *row]) for k, row in enumerate(rows)]
            self.lines += [line.lower() if style == "lower" else line for line in text]
        elif style == "large":
            rows = [fields[at : at + 4] for at in range(0, len(fields), 4)]
            rows += [[]] * (len(rows) % 2)
            self.lines += [f"{'*' if k else name + '*':8}" + "".join(f"{f:>16}" for f in row) for k, row in enumerate(rows)]
        elif style == "tabs" and len(fields) <= 8 and max(map(len, fields)) < 8:
            self.lines.append("\t".join([name, *fields]))
        else:
            self.in_small_fields(name, [fields[at : at + 8] for at in range(0, len(fields), 8)])
        if self.rng.random() < 0.05:
            self.lines.append(self.rng.choice(("$ a comment", "", "$", "   $ GRID,1")))

    def in_small_fields(self, name, rows):
        marked = self.rng.choice(("none", "plus", "column", "apart"))
        begin = f"{name:8}"
        for k, row in enumerate(rows):
            text = begin + "".join(f"{f:>8}" if self.rng.random() < 0.8 else f"{f:<8}" for f in row)
            if k + 1 < len(rows) and marked != "none":
                self.n_marks += 1
                text = f"{text:72}{'+' if marked == 'plus' else 'X'}M{self.n_marks}"
            (self.apart if k and marked == "apart" else self.lines).append(text)
            begin = f"{'+' if marked == 'none' else f'+M{self.n_marks}':8}"

    def nodes(self):
        plate, shift = self.plate, None
        if self.rng.random() < 0.3:
            shift = [0.4 / plate.metres] * 3
            ends = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)
            self.card("CORD2R", 7, 0, *shift, *(s + d for end in ends for s, d in zip(shift, end)))
        if self.rng.random() < 0.3:
            self.card("GRDSET", None, 7 if shift else None, None, None, None, 0, None)
        defaults = any("GRDSET" in line.upper() for line in self.lines)
        for number, x in plate.nodes.items():
            system = None if not shift or defaults else 7
            self.card("GRID", number, system, *((c - s for c, s in zip(x, shift)) if shift else x))

    def write(self, folder):
        plate, rng = self.plate, self.rng
        self.nodes()
        halves = rng.random() < 0.5
        for label, corners, half in plate.elements:
            self.card("CQUAD4", label, half if halves else 1, *corners)
        doubled = rng.random() < 0.15
        if doubled:
            self.card("CQUAD4", 5001, 1, *plate.elements[0][1][1:], plate.elements[0][1][0])
        for number in (1, 2) if halves else (1,):
            self.card("PSHELL", number, 3, plate.thickness(), 3, None, 3)
        self.card("MAT1", 3, plate.stress(), *rng.choice(((None, POISSON), (80.2e9 * plate.metres**2, POISSON))), plate.density())
        case = self.supports()
        bulk = "\n".join([*self.lines, *self.apart])
        if rng.random() < 0.3:
            (folder / "part.bdf").write_text("\n".join(self.lines[40:]) + "\n")
            bulk = "\n".join([*self.lines[:40], rng.choice(("INCLUDE 'part.bdf'", 'include "part.bdf"')), *self.apart])
        file = folder / rng.choice(("plate.bdf", "plate.nas", "PLATE.DAT"))
        file.write_text("\n".join(["SOL 103", "CEND", *case, "BEGIN BULK", bulk, "ENDDATA", ""]))
        return file, doubled

    def supports(self):
        held, kind = self.plate.held, self.rng.choice(("one", "each", "add", "chosen"))
        if kind == "one":
            self.card("SPC1", 1, 123456, *held)
            return []
        if kind == "each":
            for number in held:
                self.card("SPC", 1, number, 123456, 0.0)
            return ["SPC = 1"]
        if kind == "chosen":
            self.card("SPC1", 9, 3, self.plate.number(N_X, 0))
        self.card("SPC1", 2, 123, *held)
        self.card("SPC1", 3, 456, *held)
        self.card("SPCADD", 77, 2, 3)
        return [self.rng.choice(("SPC = 77", "  spc=77 $ both", "SUBCASE 1\n  SPC = 77"))]


class Abaqus:
    """Keywords in the style of pre-processors and of people."""

    def __init__(self, plate):
        self.plate, self.rng = plate, plate.rng
        self.lines = []

    def keyword(self, name, *parameters):
        equals = self.rng.choice(("=", " = ", "= "))
        words = [name] + [f"{p[0]}{equals}{p[1]}" if isinstance(p, tuple) else p for p in parameters]
        text = "*" + self.rng.choice((", ", ",", " , ")).join(words) + self.rng.choice(("", "", ",", " "))
        if len(words) > 2 and self.rng.random() < 0.2:
            text = "*" + ", ".join(words[:-1]) + ",\n" + words[-1]
        self.lines.append(self.rng.choice((str.upper, str.lower, str.title))(text))

    def data(self, *fields):
        self.lines.append(self.rng.choice((", ", ",", " ,  ")).join(f"{f:.12g}" if isinstance(f, float) else str(f) for f in fields))

    def write(self, folder):
        plate, rng = self.plate, self.rng
        instance = rng.random() < 0.4
        if instance:
            self.keyword("PART", ("NAME", "P"))
        doubled = rng.random() < 0.15
        self.model(rng.random() < 0.5, doubled)
        prefix = ""
        if instance:
            prefix = "P-1."
            self.lines += ["*END PART", "*ASSEMBLY, NAME=A"]
            self.keyword("INSTANCE", ("NAME", "P-1"), ("PART", "P"))
            if rng.random() < 0.5:
                self.data(0.2 / plate.metres, 0.0, 0.0)
            self.lines += ["*END INSTANCE", "*END ASSEMBLY"]
        self.keyword("MATERIAL", ("NAME", "STEEL"))
        self.lines += ["*ELASTIC", f"{plate.stress():.12g}, {POISSON}", "*DENSITY", f"{plate.density():.12g},"]
        in_step = rng.random() < 0.5
        support = ["*BOUNDARY", rng.choice((f"{prefix}HELD, 1, 6", f"{prefix}Held, ENCASTRE"))]
        self.lines += [] if in_step else support
        self.lines += ["*STEP, perturbation", "*FREQUENCY", "10,", *(support if in_step else []), "*END STEP", ""]
        if rng.random() < 0.3:
            (folder / "part.inp").write_text("\n".join(self.lines[1 if instance else 0 : 30]) + "\n")
            self.lines = [*self.lines[: 1 if instance else 0], "*Include, Input = part.inp", *self.lines[30:]]
        file = folder / rng.choice(("plate.inp", "PLATE.INP"))
        file.write_text("\n".join(self.lines))
        return file, doubled

    def model(self, halves, doubled):
        plate = self.plate
        self.keyword("NODE")
        for number, x in plate.nodes.items():
            self.data(number, *x)
        for half in (1, 2):
            self.keyword("ELEMENT", ("TYPE", self.rng.choice(("S4", "S4R"))), ("ELSET", f"E{half}" if halves else "PLATE"))
            for label, corners, of in plate.elements:
                if of == half:
                    self.data(label, *corners)
            if doubled and plate.elements[0][2] == half:
                self.data(5001, *plate.elements[0][1])
        if halves and self.rng.random() < 0.5:
            self.keyword("ELSET", ("ELSET", "PLATE"), "INTERNAL")
            self.data("E1", "E2")
            halves = False
        self.keyword("NSET", ("NSET", "HELD"))
        self.data(*plate.held)
        for name in ("E1", "E2") if halves else ("PLATE",):
            self.keyword("SHELL SECTION", ("ELSET", name), ("MATERIAL", "STEEL"))
            self.data(plate.thickness(), 5)


def gmsh_file(plate, folder):
    """Version 2.2, with the elements of the second half once for each of two groups."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '1 1 "held"', '2 1 "plate"', '2 2 "plate too"',
             "$EndPhysicalNames", "$Nodes", str(len(plate.nodes))]  # fmt: skip
    lines += [" ".join([str(n), *(f"{c:.12g}" for c in x)]) for n, x in plate.nodes.items()]
    groups = [(corners, 1) for _, corners, _ in plate.elements] + [(corners, 2) for _, corners, half in plate.elements if half == 2]
    plate.rng.shuffle(groups)
    edge = [(plate.number(0, j), plate.number(0, j + 1)) for j in range(N_Y)]
    lines += ["$EndNodes", "$Elements", str(len(groups) + len(edge))]
    lines += [f"{k} 1 2 1 7 {a} {b}" for k, (a, b) in enumerate(edge, 1)]
    lines += [f"{k} 3 2 {group} {group} {' '.join(map(str, corners))}" for k, (corners, group) in enumerate(groups, 100)]
    file = folder / plate.rng.choice(("plate.msh", "PLATE.MSH"))
    file.write_text("\n".join([*lines, "$EndElements", ""]))
    return file


def universal_file(plate, folder):
    """Datasets with words between them; an element of two groups may stand there twice."""
    def dataset(number, lines):
        return ["    -1", f"{number:6}", *lines, "    -1"]

    nodes = [line for n, x in plate.nodes.items() for line in (f"{n:10}         1         1        11", "".join(f"{c:25.16E}" for c in x))]
    elements = [(label, corners) for label, corners, _ in plate.elements]
    twice = [(label + 2000, corners[2:] + corners[:2]) for label, corners, half in plate.elements if half == 2]
    plain = plate.rng.random() < 0.5
    twice = [] if plain else twice
    quads = [line for label, corners in elements + twice for line in (f"{label:10}        94         1         1         7         4", "".join(f"{c:10}" for c in corners))]
    def members(kind, numbers):
        return [f"{kind:10}{n:10}         0         0" for n in numbers]

    groups = [f"         1         0         0         0         0         0         0{len(elements):10}", "plate", *members(8, (e[0] for e in elements))]
    groups += [f"         2         0         0         0         0         0         0{len(plate.held):10}", "held", *members(7, plate.held)]
    if twice:
        groups += [f"         3         0         0         0         0         0         0{len(twice):10}", "too", *members(8, (e[0] for e in twice))]
    words = plate.rng.choice(([], ["Workpiece", "written by 2 people"]))
    file = folder / plate.rng.choice(("plate.unv", "PLATE.UNV"))
    file.write_text("\n".join([*dataset(2411, nodes), *words, *dataset(2412, quads), *words, *dataset(2467, groups), ""]))
    return file


def scene(file, unit):
    return (f'name = "plate"\n[mesh]\nfile = "{file.name}"\nlength_unit = "{unit}"\n'
            f"[material.steel]\nyoung = {YOUNG}\npoisson = {POISSON}\ndensity = {DENSITY}\n"
            f'[[section]]\ngroup = "plate"\ntype = "shell"\nmaterial = "steel"\nthickness = {THICKNESS}\n'
            '[[support]]\ngroup = "held"\ntype = "clamped"\n[modes]\ncount = 6\n')  # fmt: skip


def is_named(done, file):
    """Whether a refusal is one that names the file, and a line of it."""
    return done.returncode == 1 and file.name in done.stderr and "line " in done.stderr


def written(plate, folder):
    """A scene on the plate, and whether its deck has an element twice."""
    unit = "m" if plate.metres == 1.0 else "mm"
    path = folder / "plate.toml"
    kind = plate.rng.choice((gmsh_file, universal_file, Nastran, Nastran, Abaqus, Abaqus))
    if kind in (gmsh_file, universal_file):
        path.write_text(scene(kind(plate, folder), unit))
        return path, False, ""
    file, doubled = kind(plate).write(folder)
    return path, doubled, (file, unit)


def failures(programs, folder, seed):
    chladni, rng = programs / "chladni", random.Random(seed)
    path, doubled, deck = written(Plate(rng), folder)
    if deck:
        done = start(chladni, "import", deck[0], "--length-unit", deck[1], "--output", path)
        if done.returncode != 0:
            yield f"refused: {done.stderr.strip()}" + ("" if is_named(done, deck[0]) else " (without file and line)")
            return
        text = path.read_text().replace("count = 10", "count = 6")
        path.write_text(text)
        if doubled:
            done = start(chladni, "modes", path, "--output", folder / "out")
            if not is_named(done, deck[0]) or "doubled_elements" not in done.stderr:
                yield f"an element twice: {done.returncode} {done.stderr}"
            path.write_text(text.replace("[mesh]", '[mesh]\ndoubled_elements = "merge"'))
    found = summary(chladni, "modes", path, "--output", folder / "out")["frequencies_Hz"]
    for f, g in zip(found, REFERENCE, strict=True):
        if abs(f - g) > 1e-9 * g:
            yield f"{f} Hz instead of {g} Hz"


class Plain:
    """Takes the first of all choices, and shuffles nothing."""

    random = staticmethod(lambda: 0.25)
    choice = staticmethod(lambda all_of: all_of[0])
    shuffle = staticmethod(lambda all_of: None)
    sample = staticmethod(lambda numbers, n: list(numbers)[:n])
    randrange = staticmethod(lambda n: 0)


def reference(programs, folder):
    plate = Plate(Plain)
    path = folder / "plain.toml"
    path.write_text(scene(gmsh_file(plate, folder), "m"))
    found = summary(programs / "chladni", "modes", path, "--output", folder / "out")["frequencies_Hz"]
    wrong = [(f, g) for f, g in zip(found, FIRST, strict=True) if abs(f - g) > 1e-5 * g]
    if wrong:
        sys.exit(f"FAILED: the plain plate has {wrong}")
    return found


def commits():
    done = subprocess.run(["git", "-C", str(Path(__file__).parent), "rev-list", "--count", "HEAD"], capture_output=True, text=True, check=False)
    return int(done.stdout or 1)


def plain_bulk(*more, order=1, without=()):
    """The plain plate as cards in free fields; of order 2 without some of the middle nodes."""
    plate = Plate(Plain)
    nodes, lines, middles = dict(plate.nodes), [], {}
    for label, corners, half in plate.elements:
        ends = list(zip(corners, corners[1:] + corners[:1]))
        for a, b in ends if order == 2 else ():
            if frozenset((a, b)) not in middles:
                middles[frozenset((a, b))] = 1000 + len(middles)
                nodes[middles[frozenset((a, b))]] = [(p + q) / 2 for p, q in zip(nodes[a], nodes[b])]
        sides = ["" if middles[frozenset(e)] in without else middles[frozenset(e)] for e in ends] if order == 2 else []
        fields = [label, half, *corners, *sides]
        lines.append("CQUAD8," + ",".join(map(str, fields[:8])) + "\n," + ",".join(map(str, fields[8:])) if sides
                     else "CQUAD4," + ",".join(map(str, fields)))  # fmt: skip
    held = [*plate.held, *(middles[frozenset(e)] for e in zip(plate.held, plate.held[1:]) if middles)]
    lines += [f"GRID,{n},,{x[0]:.9f},{x[1]:.9f},{x[2]:.9f}" for n, x in nodes.items() if n not in without]
    lines += [f"PSHELL,{k},3,{THICKNESS},3,,3" for k in (1, 2)] + [f"MAT1,3,2.07+11,,{POISSON},{DENSITY}"]
    lines += [f"SPC1,1,123456,{n}" for n in held if n not in without]
    return "\n".join([*lines, *more, "ENDDATA", ""])


def of_deck(programs, folder, name, text, *changes):
    """Frequencies of a deck in m, of the scene that is made of it with (old, new) put in."""
    (folder / name).write_text(text)
    path = folder / f"{name}.toml"
    done = start(programs / "chladni", "import", folder / name, "--length-unit", "m", "--output", path)
    if done.returncode != 0:
        sys.exit(f"FAILED: {name}: {done.stderr}")
    scene_text = path.read_text()
    for old, new in changes:
        assert old in scene_text, f"{old!r} must stand in the scene\n{scene_text}"
        scene_text = scene_text.replace(old, new)
    path.write_text(scene_text)
    return summary(programs / "chladni", "modes", path, "--output", folder / f"of_{name}")["frequencies_Hz"]


def differ(name, found, right, digits):
    for f, g in zip(found, right):
        if abs(f - g) > digits * g:
            yield f"{name}: {f} Hz instead of {g} Hz"


# The edge x = 1.2 m turns about a node 0.3 m beyond it: an assembly of its own, with rigid arms.
AWAY = [18.5365, 20.6614, 71.9406, 79.6319, 130.9305, 192.0894]


def reference_nodes(programs, folder):
    edge = [7, 14, 21, 28, 35]
    rbe2 = ["GRID,900,,1.5,.4,0.", "RBE2,900,900,123456," + ",".join(map(str, edge[:4])), f",{edge[4]}"]
    found = of_deck(programs, folder, "away.bdf", plain_bulk(*rbe2, "SPC1,1,123,900"))
    yield from differ("RBE2 away from its nodes", found, AWAY, 5e-6)
    inp = "*NODE\n" + "".join(f"{n}, {', '.join(map(str, x))}\n" for n, x in Plate(Plain).nodes.items()) + "900, 1.5, 0.4\n"
    inp += "*ELEMENT, TYPE=S4, ELSET=PLATE\n" + "".join(f"{k}, {', '.join(map(str, c))}\n" for k, c, _ in Plate(Plain).elements)
    inp += ("*NSET, NSET=TIP\n7, 14, 21, 28, 35\n*NSET, NSET=HELD\n1, 8, 15, 22, 29\n*SURFACE, NAME=T, TYPE=NODE\nTIP\n"
            "*SHELL SECTION, ELSET=PLATE, MATERIAL=S\n0.01\n*MATERIAL, NAME=S\n*ELASTIC\n2.07e11, 0.29\n*DENSITY\n7820.\n"
            "*COUPLING, CONSTRAINT NAME=C, REF NODE=900, SURFACE=T\n*KINEMATIC\n*BOUNDARY\nHELD, 1, 6\n900, 1, 3\n")  # fmt: skip
    yield from differ("*COUPLING away from its nodes", of_deck(programs, folder, "away.inp", inp), AWAY, 5e-6)
    # Two masses at the ends of a lever, as nodes that follow and as offsets from the reference node.
    lever = [*rbe2[:1], rbe2[1], f"{rbe2[2]},901,902", "GRID,901,,1.4,-.2,.3", "GRID,902,,1.8,.9,-.1"]
    at_ends = of_deck(programs, folder, "lever.bdf", plain_bulk(*lever, "CONM2,1,901,,5.", "CONM2,2,902,,3.,.1"))
    by_offset = of_deck(programs, folder, "offset.bdf", plain_bulk(*rbe2, "CONM2,1,900,,5.,-.1,-.6,.3", "CONM2,2,900,,3.,.4,.5,-.1"))
    yield from differ("two masses at a lever", at_ends, by_offset, 1e-9)
    hung = [*rbe2, "GRID,901,,1.4,-.2,.3", "RBAR,901,900,901,123456", "GRID,902,,1.8,.9,-.1", "RBE2,902,901,123456,902"]
    chain = of_deck(programs, folder, "chain.bdf", plain_bulk(*hung, "CONM2,1,901,,5.", "CONM2,2,902,,3.,.1"))
    yield from differ("two masses at a chain of levers", chain, by_offset, 1e-9)
    # Along the normal of a shell's node; across it nothing but a numerical stiffness would resist.
    up = ["GRID,901,,1.2,.4,{}", "RBE2,901,21,123456,901", "CONM2,1,901,,5.{}"]
    at_node = of_deck(programs, folder, "node.bdf", plain_bulk(up[0].format(".3"), up[1], up[2].format("")))
    beside = of_deck(programs, folder, "beside.bdf", plain_bulk("CONM2,1,21,,5.,0.,0.,.3"))
    yield from differ("a mass at a lever of a node", at_node, beside, 1e-9)
    (folder / "across.bdf").write_text(plain_bulk("GRID,901,,1.4,.4,.3", *up[1:2], up[2].format("")))
    run(programs / "chladni", "import", folder / "across.bdf", "--length-unit", "m", "--output", folder / "across.toml")
    done = start(programs / "chladni", "modes", folder / "across.toml", "--output", folder / "across")
    if done.returncode != 1 or "numerical stiffness" not in done.stderr:
        yield f"a lever across the normal of a shell's node: {done.returncode} {done.stderr}"
    # A mean whose reference node is elsewhere: the load's arm, or a mass with an offset.
    rbe3 = "RBE3,900,,{},123456,1.,123,7,14\n,21,28,35,6,13"
    mean = of_deck(programs, folder, "mean.bdf", plain_bulk("GRID,900,,1.5,.4,.2", rbe3.format(900), "CONM2,1,900,,5."))
    centre = of_deck(programs, folder, "centre.bdf", plain_bulk("GRID,901,,1.2,.4,0.", rbe3.format(901), "CONM2,1,901,,5.,.3,0.,.2"))
    yield from differ("a mean away from its nodes", mean, centre, 1e-9)
    on_mean = [rbe3.format(900), "GRID,900,,1.2,.4,0.", "GRID,902,,1.5,.4,.2", "RBE2,902,900,123456,902", "CONM2,1,902,,5."]
    yield from differ("a lever at a mean", of_deck(programs, folder, "on_mean.bdf", plain_bulk(*on_mean)), centre, 1e-9)


def joined_halves(programs, folder):
    """The plate cut at x = 0.6 m, and joined by equations or bars between nodes at one place."""
    line = [4, 11, 18, 25, 32]
    for kind in ("MPC", "RBAR"):
        lines = []
        for text in plain_bulk().splitlines():
            words = text.split(",")
            if words[0] == "CQUAD4" and words[2] == "2":
                words[3:] = [str(int(n) + 500) if int(n) in line else n for n in words[3:]]
            lines.append(",".join(words))
            if words[0] == "GRID" and int(words[1]) in line:
                lines.append(",".join(["GRID", str(int(words[1]) + 500), *words[2:]]))
        for n in line:
            joints = [f"MPC,1,{n + 500},{c},1.,{n},{c},-1." for c in range(1, 7)] if kind == "MPC" else [f"RBAR,{n},{n},{n + 500},123456"]
            lines[-1:-1] = joints
        found = of_deck(programs, folder, f"{kind}.bdf", "\n".join([*lines, ""]))
        yield from differ(f"halves joined by {kind}", found, REFERENCE, 1e-9)


def other_cards(programs, folder):
    bar = ["CBAR,900,9,7,14,1.,0.,0.", "PBAR,9,3,1.-4,1.-8,4.-8,2.-8"]
    stiff = of_deck(programs, folder, "bar.bdf", plain_bulk(*bar))
    zero = of_deck(programs, folder, "zero.bdf", plain_bulk(*bar, ",0.,0.,0.,0.,0.,0.,0.,0.", ",0.,0."))
    yield from differ("K1 = K2 = 0", zero, stiff, 1e-12)
    whole = of_deck(programs, folder, "whole.bdf", plain_bulk(order=2))
    holes = of_deck(programs, folder, "holes.bdf", plain_bulk(order=2, without=(1000, 1003, 1017, 1040)))
    yield from differ("CQUAD8 without middle nodes", holes, whole, 1e-9)


programs = Path(sys.argv[1])
count = int(sys.argv[2]) if len(sys.argv) > 2 else COUNT
first_seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1000 * commits()
with tempfile.TemporaryDirectory() as name:
    (Path(name) / "plain").mkdir()
    REFERENCE = reference(programs, Path(name) / "plain")
    failed = 0
    for cases in (reference_nodes, joined_halves, other_cards):
        (Path(name) / cases.__name__).mkdir()
        for failure in cases(programs, Path(name) / cases.__name__):
            failed += 1
            print(f"FAILED: {failure}")
    for seed in range(first_seed, first_seed + count):
        folder = Path(name) / str(seed)
        folder.mkdir()
        for failure in failures(programs, folder, seed):
            failed += 1
            print(f"FAILED: seed {seed} ({' '.join(sorted(f.name for f in folder.iterdir()))}): {failure}")
print(f"{count} plates from seed {first_seed} on, {failed} failures")
sys.exit(bool(failed))
