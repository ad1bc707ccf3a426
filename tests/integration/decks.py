"""A plate from a deck of Nastran or Abaqus has the frequencies of the same mesh from Gmsh's format, with the scene that is
made of the deck and with one by hand. A body in two parts that equations or a tie join has those of the body in one piece, supports in
axes of their own those of a turned body, and cards of Nastran for rigid bodies and means those of the equations that they stand for.

Usage: decks.py PROGRAM_DIR
"""

import math
import sys
import tempfile
from pathlib import Path

from plate_files import THICKNESS, frequencies, gmsh_file, grid, scene
from running import run, start, summary


def card(name, *fields):
    """In small fields."""
    rows = [fields[at : at + 8] for at in range(0, len(fields), 8)]
    return "\n".join(f"{name if k == 0 else '':8}" + "".join(f"{field!s:8}" for field in row) for k, row in enumerate(rows))


def deck(order):
    nodes, quads, triangles = grid(order)
    lines = ["SOL 103", "CEND", "BEGIN BULK", "PARAM,POST,-1"]
    lines += [card("GRID", n, "", x, y, 0.0) for n, x, y in nodes]
    kinds = (("CTRIA3", triangles), ("CQUAD4", quads)) if order == 1 else (("CTRIA6", triangles), ("CQUAD8", quads))
    elements = [(kind, of) for kind, all_of in kinds for of in all_of]
    lines += [card(kind, k, 1, *of) for k, (kind, of) in enumerate(elements, 100)]
    held = [n for n, x, _ in nodes if x == 0.0]
    lines += [f"PSHELL,1,1,{THICKNESS}.,1,,1", "MAT1,1,2.1+5,,.3,7.85-9", card("SPC1", 1, 123456, *held), "ENDDATA", ""]
    return "\n".join(lines)


def input_file(order):
    nodes, quads, triangles = grid(order)
    kinds = (("S3", triangles), ("S4R", quads)) if order == 1 else (("STRI65", triangles), ("S8R", quads))
    lines = ["*Heading", "a plate", "*Node"] + [f"{n}, {x}, {y}, 0." for n, x, y in nodes]
    for k, (kind, all_of) in enumerate(kinds, 1):
        lines.append(f"*Element, type={kind}, elset=Plate")
        lines += [f"{1000 * k + e}, {', '.join(map(str, of))}" for e, of in enumerate(all_of)]
    lines += ["*Nset, nset=Root"] + [f"{n}," for n, x, _ in nodes if x == 0.0]
    lines += ["*Material, name=Steel", "*Elastic", "2.1e5, 0.3", "*Density", "7.85e-9,", "*Boundary", "Root, ENCASTRE",
              "*Shell Section, elset=Plate, material=Steel", f"{THICKNESS}., 5", ""]  # fmt: skip
    return "\n".join(lines)


def of_order(chladni, folder, order):
    (folder / "plate.bdf").write_text(deck(order))
    (folder / "plate.inp").write_text(input_file(order))
    (folder / "plate.msh").write_text(gmsh_file(order))
    (folder / "msh.toml").write_text(scene("plate.msh", "plate", "root"))
    (folder / "bdf.toml").write_text(scene("plate.bdf", "pshell_1", "spc_1_123456"))
    (folder / "inp.toml").write_text(scene("plate.inp", "PLATE", "ROOT"))
    for kind in ("bdf", "inp"):
        scene_file = folder / f"imported_{kind}.toml"
        run(chladni, "import", folder / f"plate.{kind}", "--length-unit", "mm", "--output", scene_file)
    expected = frequencies(chladni, folder / "msh.toml")
    for name in ("bdf.toml", "imported_bdf.toml", "inp.toml", "imported_inp.toml"):
        found = frequencies(chladni, folder / name)
        for f, g in zip(found, expected, strict=True):
            if abs(f - g) > 1e-9 * g:  # the order of sums differs
                yield f"{name}, order {order}: {f} Hz instead of {g} Hz"


def nodes_have_thicknesses(chladni, folder):
    """*NODAL THICKNESS takes the place of that of the section."""
    plain = input_file(1)
    rows = "\n".join(f"{n}, {2.0 * THICKNESS + 0.001 * x!r}" for n, x, _ in grid(1)[0])
    (folder / "nodal.inp").write_text(plain.replace("*Material", f"*Nodal Thickness\n{rows}\n*Material"))
    run(chladni, "import", folder / "nodal.inp", "--length-unit", "mm", "--output", folder / "nodal.toml")
    by_nodes = frequencies(chladni, folder / "nodal.toml")
    (folder / "linear.inp").write_text(plain)
    run(chladni, "import", folder / "linear.inp", "--length-unit", "mm", "--output", folder / "linear.toml")
    text = (folder / "linear.toml").read_text()
    line = next(line for line in text.split("\n") if line.startswith("thickness"))
    (folder / "linear.toml").write_text(text.replace(line, f'thickness = "{2e-3 * THICKNESS!r} + 0.001 * x"'))
    for f, g in zip(by_nodes, frequencies(chladni, folder / "linear.toml"), strict=True):
        if abs(f - g) > 1e-9 * g:
            yield f"thicknesses of nodes: {f} Hz instead of {g} Hz"


def units_are_asked_for(chladni, folder):
    for words in (("mesh", folder / "plate.bdf"), ("import", folder / "plate.bdf")):
        done = start(chladni, *words)
        if done.returncode == 0 or "length-unit" not in done.stderr:
            yield f"{words[0]} does not ask for the unit: {done.stderr}"
    (folder / "no_unit.toml").write_text(scene("plate.bdf", "pshell_1", "spc_1_123456").replace('length_unit = "mm"', ""))
    done = start(chladni, "mesh", folder / "no_unit.toml")
    if done.returncode != 1 or "length_unit" not in done.stderr:
        yield f"a scene without a unit: {done.stderr}"


def bad_decks_are_refused(chladni, folder):
    """What the deck declares is checked as what a user writes."""
    (folder / "thin.bdf").write_text(deck(1).replace("MAT1,1,2.1+5,,.3", "MAT1,1,2.1+5,,.7"))
    done = start(chladni, "import", folder / "thin.bdf", "--length-unit", "mm", "--output", folder / "thin.toml")
    if done.returncode != 1 or "poisson" not in done.stderr or (folder / "thin.toml").exists():
        yield f"a material that is none: {done.stderr}"
    (folder / "light.bdf").write_text(deck(1).replace(",7.85-9", ""))
    run(chladni, "import", folder / "light.bdf", "--length-unit", "mm", "--output", folder / "light.toml")
    done = start(chladni, "modes", folder / "light.toml", "--output", folder)
    if done.returncode == 0 or "no density" not in done.stderr:
        yield f"modes of a body without mass: {done.stderr}"


def loaded_states_are_told(chladni, folder):
    """Vibrations about a loaded state are not those that are found."""
    steps = "*Step\n*Static\n*End Step\n*Step, Perturbation\n*Frequency\n3\n*End Step\n"
    (folder / "loaded.inp").write_text(input_file(1) + steps)
    said = run(chladni, "import", folder / "loaded.inp", "--length-unit", "mm", "--output", folder / "loaded.toml")
    if "of the body without loads are found" not in said:
        yield f"vibrations about a loaded state: {said!r}"


def body(*parts, turn=0.0, end=""):
    """Blocks (x from, x to, elements along x, y and z) of 10 mm x 8 mm in an input file; node sets LOW_k and HIGH_k of their ends, elements LAST_k at HIGH_k."""
    lines, sets, node, element = ["*Node"], [], 0, 0
    c, s = math.cos(turn), math.sin(turn)
    for p, (low, high, n_x, n_y, n_z) in enumerate(parts):
        number = {}
        for i in range(n_x + 1):
            for j in range(n_y + 1):
                for k in range(n_z + 1):
                    node += 1
                    number[i, j, k] = node
                    x, y = low + (high - low) * i / n_x, 10 * j / n_y
                    lines.append(f"{node}, {c * x - s * y!r}, {s * x + c * y!r}, {8 * k / n_z!r}")
        sets.append(f"*Element, type=C3D8, elset=Part{p}")
        first = element + 1
        for i in range(n_x):
            for j in range(n_y):
                for k in range(n_z):
                    element += 1
                    sets.append(", ".join(map(str, [element, *(number[i + a, j + b, k + e] for e in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)))])))
        sets += [f"*Elset, elset=Last_{p}, generate", f"{element + 1 - n_y * n_z}, {element}", f"*Elset, elset=All, generate", f"{first}, {element}"]
        for name, i in ("Low", 0), ("High", n_x):
            sets += [f"*Nset, nset={name}_{p}"] + [f"{number[i, j, k]}," for j in range(n_y + 1) for k in range(n_z + 1)]
    return "\n".join([*lines, *sets, "*Material, name=Steel", "*Elastic", "2.1e5, 0.3", "*Density", "7.85e-9,", "*Solid Section, elset=All, material=Steel", end, ""])


TIE = "*Surface, name=Follows, type=node\nLow_1\n*Surface, name=Leads\nLast_0, S4\n*Tie, name=T\nFollows, Leads\n"


def modes(chladni, folder, name, text):
    """The summary of `chladni modes` of the scene that `chladni import` makes."""
    (folder / name).write_text(text)
    run(chladni, "import", folder / name, "--length-unit", "mm", "--output", folder / f"{name}.toml")
    return summary(chladni, "modes", folder / f"{name}.toml", "--output", folder)


def same(what, found, expected, of=1e-9):
    for f, g in zip(found["frequencies_Hz"], expected["frequencies_Hz"], strict=True):
        if abs(f - g) > of * max(g, 100.0):  # frequencies of free bodies are 0 to rounding
            yield f"{what}: {f} Hz instead of {g} Hz"


def parts_are_joined(chladni, folder):
    """By equations of sets, and by a tie of faces with the same nodes; of faces with other nodes rigid motions stay free."""
    held, halves = "*Boundary\nLow_0, 1, 3\n", ((0, 20, 4, 2, 2), (20, 40, 4, 2, 2))
    whole = modes(chladni, folder, "whole.inp", body((0, 40, 8, 2, 2), end=held))
    equations = "*Equation\n" + "".join(f"2\nLow_1, {c}, 2., High_0, {c}, -2.\n" for c in (1, 2, 3))
    yield from same("equations", modes(chladni, folder, "equations.inp", body(*halves, end=equations + held)), whole)
    yield from same("a tie", modes(chladni, folder, "tie.inp", body(*halves, end=TIE + held)), whole)
    free = modes(chladni, folder, "free.inp", body((0, 20, 4, 2, 2), (20, 40, 4, 3, 3), end=TIE))
    if free["n_rigid"] != 6 or free["frequencies_Hz"][6] < 1000.0:
        yield f"a tie of other nodes: {free['n_rigid']} rigid motions, then {free['frequencies_Hz'][6]} Hz"
    sliding = modes(chladni, folder, "sliding.inp", body(*halves, end=equations.split("2\nLow_1, 2")[0] + held))
    if sliding["n_rigid"] != 3:  # along y and z, about x
        yield f"parts joined along x alone: {sliding['n_rigid']} rigid motions"
    finer = folder / "finer.toml"
    finer.write_text((folder / "tie.inp.toml").read_text().replace("count = 10", "count = 10\nmesh_errors = true"))
    done = start(chladni, "modes", finer, "--output", folder / "finer")
    if done.returncode == 0 or "equations and ties" not in done.stderr:
        yield f"errors of a mesh with ties are told: {done.stderr}"


def supports_turn(chladni, folder):
    """Components in the axes of *TRANSFORM are those of the body that is turned by them."""
    held = "*Boundary\nLow_0, 1\nHigh_0, 2, 3\n"
    straight = modes(chladni, folder, "straight.inp", body((0, 40, 6, 2, 2), end=held))
    axes = f"*Transform, nset=Low_0\n{math.cos(0.5)}, {math.sin(0.5)}, 0., {-math.sin(0.5)}, {math.cos(0.5)}, 0.\n"
    turned = body((0, 40, 6, 2, 2), turn=0.5, end=axes + axes.replace("Low", "High") + held)
    yield from same("turned supports", modes(chladni, folder, "turned.inp", turned), straight)


def trusses_are_springs(chladni, folder):
    """A SPRINGA along x with a mass, the same turned with the body, and a truss of E A / L in its place."""
    c, s, held = math.cos(0.5), math.sin(0.5), "*Boundary\nLow_0, 1, 3\n9001, 1, 3\n"
    spring = "*Element, type=SPRINGA, elset=S\n900, 55, 9001\n*Spring, elset=S\n\n105000.\n*Element, type=MASS, elset=M\n901, 55\n*Mass, elset=M\n7.85e-7\n"
    truss = "*Element, type=T3D2, elset=T\n900, 55, 9001\n*Solid Section, elset=T, material=Steel\n10.\n"
    straight = modes(chladni, folder, "spring.inp", body((0, 40, 6, 2, 2), end="*Node\n9001, 60., 0., 0.\n" + spring + held))
    for name, kind in ("a turned spring", spring), ("a truss", truss):
        text = body((0, 40, 6, 2, 2), turn=0.5, end=f"*Node\n9001, {60 * c!r}, {60 * s!r}, 0.\n" + kind + held)
        yield from same(name, modes(chladni, folder, "skew.inp", text), straight)


def rods_and_bushes_are_springs(chladni, folder):
    """CROD, CONROD and CBUSH from the corner at x = 300 to another one beside scalar springs and masses."""
    k, of_turn, mass = 2.1e5 * 7 / 200, 2.1e5 / 2.6 * 11 / 200, 0.5 * 7.85e-9 * 7 * 200  # from y = 0 to 200
    masses = [f"CONM2,{72 + end},{node},,{mass!r}" for end, node in enumerate((13, 117))]
    springs = [f"CELAS2,70,{k!r},13,2,117,2", f"CELAS2,71,{of_turn!r},13,5,117,5", *masses]
    kinds = {"CELAS2": springs, "CROD": ["CROD,70,5,13,117", "PROD,5,1,7.,11."], "CONROD": ["CONROD,70,13,117,1,7.,11."],
             "CBUSH": ["CBUSH,70,5,13,117,,,,0", f"PBUSH,5,K,,{k!r},,,{of_turn!r}", *masses],
             "CBUSH along its nodes": ["CBUSH,70,5,13,117", f"PBUSH,5,K,{k!r},,,{of_turn!r}", *masses]}  # fmt: skip
    found = {name: modes(chladni, folder, "rod.bdf", deck(1).replace("ENDDATA", "\n".join([*cards, "ENDDATA"]))) for name, cards in kinds.items()}
    for name in list(kinds)[1:]:
        yield from same(name, found[name], found["CELAS2"])


def cards_are_equations(chladni, folder):
    """RBE2 and RBE3 of some components, and the system CD of a support, beside MPCs written out."""
    plain = deck(1)
    corners = (13, 9, 117)  # at x = 300 and 200 on y = 0, and at x = 300, y = 200
    at = (350.0, 70.0)  # the mass stands off, so that the signs of rotations matter
    other = card("GRID", 900, "", *at, 0.0) + "\n" + card("CONM2", 1, 900, "", 1e-4, 20.0, 30.0)
    grids = {n: (x, y) for n, x, y in grid(1)[0]}

    def with_cards(*cards):
        return plain.replace("ENDDATA", "\n".join([other, *cards, "ENDDATA"]))

    def mpc(*terms):
        """Two terms to a line."""
        pairs = [terms[k : k + 2] for k in range(0, len(terms), 2)]
        return "MPC,7," + ",\n,,".join(",".join(f"{node},{c},{float(a)!r}" for node, c, a in pair) for pair in pairs)

    follows = []
    for node in corners:  # z of the node is that of the rigid body at 900, which has z, rx and ry
        x, y = grids[node][0] - at[0], grids[node][1] - at[1]
        follows.append(mpc((node, 3, -1), (900, 3, 1), (900, 4, y), (900, 5, -x)))
    rest = card("SPC1", 1, 126, 900)
    rigid, written = with_cards(card("RBE2", 8, 900, 3, *corners), rest), with_cards(*follows, rest)
    yield from same("RBE2 of component 3", modes(chladni, folder, "rbe2.bdf", rigid), modes(chladni, folder, "mpc2.bdf", written))
    mean = with_cards("RBE3,8,,900,1,1.,123,13,117\n,3.,123,9")
    by_hand = with_cards(mean_equation(grids, {13: 1.0, 117: 1.0, 9: 3.0}, at, mpc))
    yield from same("RBE3 of weights", modes(chladni, folder, "rbe3.bdf", mean), modes(chladni, folder, "mpc3.bdf", by_hand))


def wedges(text):
    """Each hexahedron as two wedges of six nodes."""
    lines = []
    for line in text.split("\n"):
        numbers = line.split(", ")
        if len(numbers) == 9:
            e, n = int(numbers[0]), numbers[1:]
            lines += [", ".join([str(2 * e - 1), n[0], n[1], n[2], n[4], n[5], n[6]]), ", ".join([str(2 * e), n[0], n[2], n[3], n[4], n[6], n[7]])]
        else:
            lines.append(line)
    return "\n".join(lines).replace("C3D8", "C3D6").replace("elset=All, material", "elset=Part0, material")


def nodes_of_no_element_move(chladni, folder):
    """Nodes of equations alone, and those that stand in the middle of the edges of a deck without them."""
    block = lambda end, of=lambda text: text: of(body((0, 40, 6, 2, 2), end=end))
    reference = "*Node\n900, 50., 5., 4.\n*Surface, type=node, name=S\nHigh_0\n*Coupling, ref node=900, surface=S, constraint name=C\n*Kinematic\n1, 2\n"
    follows = modes(chladni, folder, "kinematic.inp", block(reference + "*Boundary\nLow_0, 1, 3\n900, 1, 6\n"))
    yield from same("a held reference", follows, modes(chladni, folder, "held.inp", block("*Boundary\nLow_0, 1, 3\nHigh_0, 1, 2\n")))
    axes = "".join(f"*Transform, nset={name}_0\n0., 1., 0., -1., 0., 0.\n" for name in ("Low", "High"))
    turned = modes(chladni, folder, "wedges.inp", block(axes + "*Boundary\nLow_0, 2\nHigh_0, 1\nHigh_0, 3\n", wedges))
    yield from same("wedges held in axes", turned, modes(chladni, folder, "wedges_held.inp", block("*Boundary\nLow_0, 1\nHigh_0, 2, 3\n", wedges)))
    plate = lambda *cards: deck(1).replace("ENDDATA", "\n".join([*cards, "ENDDATA"]))
    plain = modes(chladni, folder, "plain.bdf", plate())
    yield from same("an equation of nothing", modes(chladni, folder, "nothing.bdf", plate("MPC,1,13,3,0.")), plain)
    rod = ("GRID,950,,400.,0.,0.", "CROD,70,60,13,950", "PROD,60,1,10.,30000.", "SPC1,1,123456,950")
    twisted = modes(chladni, folder, "rod.bdf", plate(*rod))
    springs = plate(f"CELAS2,71,{2.1e5 / 2.6 * 30000 / 100!r},13,4", f"CELAS2,72,{2.1e5 * 10 / 100!r},13,1", "CONM2,73,13,,3.925-6")  # and half of its mass
    yield from same("a rod to the ground", twisted, modes(chladni, folder, "springs.bdf", springs))
    rigid = ("GRID,900,,350.,40.,0.,{}", "CORD2R,5,,0.,0.,0.,0.,0.,1.,\n,0.,1.,0.", card("RBE2", 8, 900, 3, 13, 9, 117))
    for n, (words, cards) in enumerate((("no equation has its x", (rigid[0].format(""), *rigid[1:], "CELAS2,3,1000.,900,1")),
                         ("hold it in the basic axes", (rigid[0].format(5), *rigid[1:], card("SPC1", 1, 3, 900))))):  # fmt: skip
        (folder / f"no_{n}.bdf").write_text(plate(*cards))
        run(chladni, "import", folder / f"no_{n}.bdf", "--length-unit", "mm", "--output", folder / f"no_{n}.toml")
        done = start(chladni, "modes", folder / f"no_{n}.toml", "--output", folder)
        if done.returncode == 0 or words not in done.stderr:
            yield f"{words}: {done.stderr}"


def mean_equation(grids, weights, place, mpc):
    """x of a node at a place that moves as the mean does in the plane."""
    total = sum(weights.values())
    c = [sum(w * grids[n][i] for n, w in weights.items()) / total for i in (0, 1)]
    J = sum(w * ((grids[n][0] - c[0]) ** 2 + (grids[n][1] - c[1]) ** 2) for n, w in weights.items())
    terms = [(900, 1, -1.0)]
    for n, w in weights.items():  # x = mean x - theta (y - c_y), theta = sum w (r_x v - r_y u) / J
        r = [grids[n][i] - c[i] for i in (0, 1)]
        terms += [(n, 1, w / total + w * r[1] * (place[1] - c[1]) / J), (n, 2, -w * r[0] * (place[1] - c[1]) / J)]
    return mpc(*terms)


def main(programs):
    chladni = Path(programs) / "chladni"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        failures = [*of_order(chladni, folder, 1), *of_order(chladni, folder, 2),
                    *units_are_asked_for(chladni, folder), *nodes_have_thicknesses(chladni, folder), *loaded_states_are_told(chladni, folder), *bad_decks_are_refused(chladni, folder),
                    *parts_are_joined(chladni, folder), *supports_turn(chladni, folder),
                    *trusses_are_springs(chladni, folder), *rods_and_bushes_are_springs(chladni, folder), *cards_are_equations(chladni, folder), *nodes_of_no_element_move(chladni, folder)]  # fmt: skip
    print("\n".join(f"FAILED: {line}" for line in failures))
    sys.exit(bool(failures))


main(*sys.argv[1:])
