#!/usr/bin/python3
"""Which figures of the source do we reproduce, and with which numbers? Writes OUTPUT/gallery.{json,md} and OUTPUT/figures/source_*.png.

usage: gallery.py [--quick] [--programs DIR] [--keep DIR] OUTPUT

The source is Steinbrecher 2015 (docs/explanation/theory.md). A number of it stands in these scripts as its text has it; ours are of the
programs. --quick takes coarse meshes and few speeds.
"""
import argparse
import json
import tempfile
from dataclasses import asdict
from pathlib import Path

import beams
import discs
import minimal_models
import plates
import rigid
import sounds
from studies import ROOT

NOT_REPRODUCED = """## Not reproduced

Figures 2.4 to 2.6, 3.2, 4.1 to 4.3, 5.1, 5.5, 5.6, 5.12, 5.13 and A.1 are drawings of models and of the way the source's
programs are used; they show nothing computed. What stands in a figure of the source and not in its text was not available to us.
"""


def gallery(programs, folder, figures, quick):
    """(raw results, entries by chapter)"""
    found = {"minimal_models": minimal_models.study(programs, folder / "minimal_models"),
             "rigid": rigid.study(programs, folder / "rigid", quick), "beams": beams.study(programs, folder / "beams"),
             "plates": plates.study(programs, folder / "plates", quick), "discs": discs.study(programs, folder / "discs", quick),
             "sound": sounds.study(programs, folder / "discs/thick")}
    of_discs = list(discs.entries(found["discs"], folder / "discs", figures))
    return found, [
        *minimal_models.entries(found["minimal_models"], figures), *rigid.entries(found["rigid"], figures),
        *beams.entries(found["beams"], folder / "beams", figures), of_discs[0], *plates.entries(found["plates"], figures),
        *of_discs[1:], *sounds.entries(folder / "discs/thick", figures, quick)]


def shown(value):
    return "" if value is None else f"{value:.7g}" if abs(value) >= 0.1 or value == 0 else f"{value:.2e}"


def table(entries):
    lines = ["| figure | quantity | unit | source | ours | ours over source |", "| --- | --- | --- | --- | --- | --- |"]
    for entry in entries:
        for n in entry.numbers:
            ratio = "" if n.source is None else f"{n.ours / n.source:.5f}"
            lines.append(f"| {entry.figure} | {n.quantity} | {n.unit} | {shown(n.source)} | {shown(n.ours)} | {ratio} |")
    return "\n".join(lines)


# The script of each figure, by the beginning of its number; the first that fits.
SCRIPTS = {"2": "minimal_models", "3": "rigid", "4": "beams", "5.3": "plates", "5.4": "plates", "5.14": "sounds", "5.15": "sounds",
           "5.16": "sounds", "5": "discs"}


def script_of(entry):
    return next(script for figure, script in SCRIPTS.items() if f"{entry.figure}.".startswith((f"{figure}.", f"{figure},")))


def section(entry):
    images = "\n\n".join(f"![{entry.title}](figures/{image})" for image in entry.images)
    return "\n".join([f"## Figure {entry.figure}: {entry.title}", "", images, "", *([entry.remark, ""] if entry.remark else []),
                      f"Script: `benchmarks/source/{script_of(entry)}.py`.", ""])


def markdown(entries, quick):
    return "\n".join([
        "# The figures of the source", "",
        f"Written by `benchmarks/source/gallery.py`{' --quick' if quick else ''}; ours are numbers of the programs, those of the source are of the text of Steinbrecher 2015 "
        "([theory](../explanation/theory.md)). Where its text has no number the column is empty. Reasons for what differs stand below each figure.", "",
        "One command makes all of them: `./dev build`, then `/usr/bin/python3 benchmarks/source/gallery.py out`, which writes this page to `out/gallery.md` and the "
        "figures to `out/figures/`; with `--keep FOLDER` the result files of the programs stay. The script below a figure has its scenes.", "",
        table(entries), "", *map(section, entries), NOT_REPRODUCED])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--programs", type=Path, default=ROOT / "build/release/bin")
    parser.add_argument("--keep", type=Path, help="a folder for the results of the programs, which are else deleted")
    parser.add_argument("output", type=Path)
    arguments = parser.parse_args()
    figures = arguments.output / "figures"
    figures.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        found, entries = gallery(arguments.programs.resolve(), arguments.keep or Path(name), figures, arguments.quick)
    (arguments.output / "gallery.json").write_text(
        json.dumps({"entries": [asdict(entry) for entry in entries]}, indent=1) + "\n")
    (arguments.output / "gallery.md").write_text(markdown(entries, arguments.quick))


if __name__ == "__main__":
    main()
