"""A plate from a deck of Nastran or Abaqus has the frequencies of the same mesh from Gmsh's format, with the scene that is
made of the deck and with one by hand.

Usage: decks.py PROGRAM_DIR
"""

import sys
import tempfile
from pathlib import Path

from plate_files import THICKNESS, frequencies, gmsh_file, grid, scene
from running import run, start


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


def main(programs):
    chladni = Path(programs) / "chladni"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        failures = [*of_order(chladni, folder, 1), *of_order(chladni, folder, 2),
                    *units_are_asked_for(chladni, folder), *bad_decks_are_refused(chladni, folder)]  # fmt: skip
    print("\n".join(f"FAILED: {line}" for line in failures))
    sys.exit(bool(failures))


main(*sys.argv[1:])
