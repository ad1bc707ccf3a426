"""Plates of NAFEMS as decks of Nastran and Abaqus (examples/decks): the frequencies of `chladni import` and `chladni modes`
beside those that were published, and docs/results/decks.md.

Usage: public_decks.py PROGRAM_DIR [--update] [--folder NAME DIR]...

Each folder of decks becomes a row of the page: how many hold only elements that are known, how many of these pass unchanged, how
many others are told the line, and what stops them. The rows that the page has of other folders stay.
"""

import collections
import re
import sys
import tempfile
from pathlib import Path

from running import run, start, summary

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/results/decks.md"
# Published: NAFEMS R0015, as reprinted in Altair's OptiStruct verification problems OS-V 0420, 0430, 0435, 0440. The fourth frequency of
# FV22 is left out, see the page. Converged: of the shear-flexible plate, as in tests/plate/vibration_test.cpp.
# Limits: R0015 has old upper bounds for thin plates, up to 1.1 % high; the error of the coarse meshes is the rest.
CASES = {
    "fv32.bdf": ("Cantilevered tapered membrane (FV32)", 8e-3, 5e-3,
                 {1: (44.623, 44.61702), 2: (130.03, 130.0095), 3: (162.70, 162.6887), 4: (246.05, 245.9858), 5: (379.90, 379.717),
                  6: (391.44, 391.404)}),
    "fv12.bdf": ("Free thin square plate (FV12)", 1.2e-2, 3e-3,
                 {4: (1.622, 1.61839), 5: (2.360, 2.35922), 6: (2.922, 2.92177), 7: (4.233, 4.18197), 8: (4.233, 4.18197),
                  9: (7.416, 7.35316)}),
    "fv16.inp": ("Cantilevered thin square plate (FV16)", 1.2e-2, 3e-3,
                 {1: (0.421, 0.417884), 2: (1.029, 1.022699), 3: (2.582, 2.561737), 4: (3.306, 3.271953), 5: (3.753, 3.721276),
                  6: (6.555, 6.510297)}),
    "fv22.inp": ("Clamped thick rhombic plate (FV22)", 1e-2, 4e-3,
                 {1: (133.95, 133.4024), 2: (201.41, 201.9123), 3: (265.81, 266.9190), 5: (334.45, 336.118)}),
}  # fmt: skip
INTRODUCTION = """# Decks with published results

Written by `tests/integration/public_decks.py PROGRAM_DIR --update`; `integration.public_decks` computes it again. The decks of
[examples/decks](../../examples/decks) are rewritten after tests of NAFEMS (R0015, F. Abbassian, D. J. Dawswell and N. C. Knowles, Selected
Benchmarks for Natural Frequency Analysis, 1987): CQUAD8 of Nastran, S8R of Abaqus. They are read by `chladni import DECK --length-unit m`, and `chladni modes` computes the
frequencies. The published ones are those that Altair reprints (OptiStruct verification problems OS-V 0420, 0430, 0435, 0440). Those of thin plates are old upper
bounds; the converged values of the shear-flexible plate (`tests/plate/vibration_test.cpp`) show the error of the mesh. The fourth frequency of FV22 is left out:
its reprint, 283.68 Hz, is 1 % above the converged value, and the original was not available.
"""


def frequencies(chladni, deck, folder):
    scene = folder / f"{deck}.toml"
    run(chladni, "import", ROOT / "examples/decks" / deck, "--length-unit", "m", "--output", scene)
    return summary(chladni, "modes", scene, "--output", folder)["frequencies_Hz"]


def compared(chladni, folder, failures):
    """The page; what is too far from its reference is added to the failures."""
    lines = [INTRODUCTION]
    for deck, (title, limit, limit_of_mesh, modes) in CASES.items():
        found = frequencies(chladni, deck, folder)
        lines += [f"## {title}: [{deck}](../../examples/decks/{deck})", "", "| mode | published, Hz | converged, Hz | computed, Hz "
                  "| from published | from converged |", "| --- | --- | --- | --- | --- | --- |"]  # fmt: skip
        for mode, (published, converged) in modes.items():
            f = found[mode - 1]
            lines.append(f"| {mode} | {published:g} | {converged:g} | {f:.5g} | {100 * (f / published - 1):+.2f} % "
                         f"| {100 * (f / converged - 1):+.2f} % |")  # fmt: skip
            if abs(f / published - 1) > limit or abs(f / converged - 1) > limit_of_mesh:
                failures.append(f"{deck}, mode {mode}: {f} Hz, published {published}, converged {converged}")
        lines.append("")
    return "\n".join(lines)


KINDS = """## Decks of other people

`public_decks.py PROGRAM_DIR --folder NAME DIR --update` adds a row for a folder of decks, which are no part of the repository. A deck passes if
`chladni import` and `chladni mesh` of its scene end well as it stands. Known elements are shells, beams, solids, masses, springs and rods. Of the decks that hold no
others, those are no subject of linear vibrations of solids whose keywords say something of a contact, of rubber, of a user's material or of electricity, and those of heat
alone, without an elastic material. The rest counts, also decks for statics, plasticity, temperatures, laminates and anisotropic materials. Of those that do not pass, told are
those that are refused by one sentence that names a line.

| decks | files | of known elements alone | a subject | pass | told the line | what stops the others, by number |
| --- | --- | --- | --- | --- | --- | --- |
"""
KNOWN = {
    ".inp": (r"(?im)^\*element\b(?! *output)[^\n]*?type *= *([a-z0-9]+)", set(
        "S3 S3R S3RS S4 S4R S4RS S4R5 S6 S8 S8R S8R5 STRI65 C3D4 C3D6 C3D8 C3D8R C3D8I C3D10 C3D10M C3D15 C3D20 C3D20R B31 B31R B32 B32R T3D2 T3D3 MASS "
        "SPRING1 SPRING2 SPRINGA DASHPOTA DASHPOT1 DASHPOT2".split())),
    ".bdf": (r"(?im)^ *(C(?!ORD|END)[A-Z]+[0-9]*)[ *,]",
             set("CBAR CBEAM CTRIA3 CTRIA6 CQUAD4 CQUAD8 CTETRA CPENTA CHEXA CONM2 CELAS1 CELAS2 CROD CONROD CBUSH".split())),
}  # fmt: skip
NO_SUBJECT = re.compile(r"(?im)^\*(contact|user material|hyperelastic|hyperfoam|deformation plasticity|gap|electr|fluid)|^ *(CGAP|MAT10|MATHP|CHBDY[A-Z]+)[ *,]")
ELASTIC = re.compile(r"(?im)^\*elastic|^ *(MAT[1-9])[ *,]")


def row(chladni, name, folder):
    """What becomes of the decks of a folder."""
    n_files, n_known, n_counted, n_passed, n_told, stops = 0, 0, 0, 0, 0, collections.Counter()
    for deck in sorted(path for path in folder.rglob("*") if path.suffix.lower() in (*KNOWN, ".nas", ".dat")):
        n_files += 1
        pattern, known = KNOWN[".inp" if deck.suffix.lower() == ".inp" else ".bdf"]
        text = deck.read_text(encoding="utf-8", errors="replace")
        types = {kind.upper() for kind in re.findall(pattern, text)}
        if not types or types - known:
            continue
        n_known += 1
        if NO_SUBJECT.search(text) or not ELASTIC.search(text):
            continue
        n_counted += 1
        with tempfile.TemporaryDirectory() as out:
            done = start(chladni, "import", deck, "--length-unit", "mm", "--output", f"{out}/scene.toml")
            if done.returncode == 0:
                done = start(chladni, "mesh", f"{out}/scene.toml", "--output", out)
        said = done.stderr.strip().splitlines()
        if done.returncode == 0:
            n_passed += 1
            continue
        n_told += len(said) == 1 and bool(re.search(r"line \d+", said[0]))
        words = re.search(r"line \d+: ([^:]*)", said[-1]) if said else None
        stops[words[1] if words else "no line"] += 1
        print(f"{deck.name}: {said[-1] if said else done.returncode}")
    most = ", ".join(f"{words} {n}" for words, n in stops.most_common(8))
    return f"| {name} | {n_files} | {n_known} | {n_counted} | {n_passed} | {n_told} | {most} |"


def with_rows(page, rows):
    """The second part of the page with rows anew by their names."""
    old = re.findall(r"^\| (?!decks|---)[^\n]*$", page[page.index("## Decks of other people") :], re.M) if "## Decks of other" in page else []
    table = {line.split("|")[1].strip(): line for line in [*old, *rows]}
    return KINDS + "\n".join([*table.values(), ""])


def differs(page, text):
    """Whether words differ, or numbers by more than their last digit."""
    number = re.compile(r"[-+]?\d+\.\d+")
    if number.sub("", page) != number.sub("", text):
        return True
    pairs = zip(map(float, number.findall(page)), map(float, number.findall(text)))
    return any(abs(a - b) > 0.011 + 1e-4 * abs(b) for a, b in pairs)


def main(programs, words):
    failures, chladni = [], programs / "chladni"
    with tempfile.TemporaryDirectory() as folder:
        text = compared(chladni, Path(folder), failures)
    folders = [words[i + 1 : i + 3] for i, word in enumerate(words) if word == "--folder"]
    text += "\n" + with_rows(PAGE.read_text(), [row(chladni, name, Path(folder)) for name, folder in folders])
    print(text)
    if "--update" in words:
        PAGE.write_text(text)
    elif differs(PAGE.read_text(), text):
        failures.append("docs/results/decks.md is out of date; run this with --update")
    print("\n".join(f"FAILED: {line}" for line in failures))
    return bool(failures)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve(), sys.argv[2:]))
