"""The table of unstable modes of a body as `chladni` makes it: in the terminal, in JSON, and on the page.

Usage: unstable_modes.py PROGRAM_DIR [CHROMIUM]
"""

import json
import re
import sys
import tempfile
from pathlib import Path

from report import browse, content_of, draw
from running import changed, run

DATA = Path(__file__).parents[1] / "data"
BRAKE = """
[squeal]
ring = "track"
thickness = 0.02
speeds = { from_rad_s = 3.0, to_rad_s = 60.0, count = 12 }
friction = 0.6
pads = [{ angle_deg = 0.0, stiffness = 6e6, damping = 2.0, preload = 2000.0 }]
analyses = ["eigenvalues", "stability", "limit-cycle-direct", "limit-cycle-branch", "rotation-stability"]
limit_cycle_direct = { speed_rad_s = 40.0 }
"""
FINE = (("element_size = 0.03", "element_size = 0.02"), ("nodes = 12", "nodes = 24"), ("modes = 20", "modes = 60"),
        ("keep = { modes = 30 }", "keep = { up_to_Hz = 6000.0 }"))
KEYS = {"unstable", "worst_value", "worst_growth_1_s", "worst_growth_errors_1_s", "worst_frequency_Hz", "damping_ratio", "nodal_diameters", "nodal_circles",
        "in_plane", "shares", "pads", "friction_work", "normal_work", "damping_work", "growth_1_s", "frequency_Hz"}


def check_json(found):
    """The works of all forces in a period sum to 2 growth / frequency, which is -4 pi times the damping ratio."""
    table = found["stability_table"]
    unstable = [branch for branch in table["branches"] if branch["unstable"]]
    assert len(unstable) >= 2 and len(unstable) < len(table["branches"]), table["summary"]
    assert f"{len(unstable)} of {len(table['branches'])} modes" in table["summary"], table["summary"]
    for branch in table["branches"]:
        assert set(branch) == KEYS, set(branch) ^ KEYS
        assert abs(sum(branch["shares"]) + branch["pads"] - 1) < 1e-9, branch["shares"]
        works = [branch[f"{part}_work"] for part in ("friction", "normal", "damping")]
        if not branch["unstable"]:
            assert works == [None] * 3, works
            continue
        gain = 2 * branch["worst_growth_1_s"] / branch["worst_frequency_Hz"]
        assert branch["worst_growth_1_s"] > 0 > branch["damping_ratio"], branch
        assert abs(sum(works) - gain) < 1e-5 * max(map(abs, works)) + 1e-10, (works, gain)
    assert any(branch["friction_work"] > 0 for branch in unstable)
    return unstable


def check_branch(found):
    """Limit cycles begin where sliding loses its stability first, or say why not."""
    origin = found["limit_cycle_branch_origin"]
    limits = [limit for branch in found["stability_table"]["branches"] for limit in branch["unstable"]]
    if origin["hopf_speed_rad_s"] is None:
        assert min(begin for begin, _ in limits) == 3.0 and "no Hopf point" in origin["note"], origin
    else:
        nearest = min(abs(begin - origin["hopf_speed_rad_s"]) for begin, _ in limits)
        assert nearest < 1e-6, (origin, limits)


def check_direct(found, said):
    """What led to the cycle is told."""
    way = found["limit_cycle_direct"]["way"]
    assert way == "from the eigenvector" and way in said, (way, said)


def first_cells(said):
    """Of each row of the tables; a long cell goes on in indented lines."""
    cells = []
    for line in said.splitlines():
        if line.startswith("  ") and cells:
            cells[-1] += " " + line.strip()
        else:
            cells.append(line.split("   ")[0])
    return cells


def check_terminal(said, unstable):
    assert max(map(len, said.splitlines())) <= 120, said
    rows = [cell for cell in first_cells(said) if cell.startswith("largest growth, at ")]
    assert len(rows) == len(unstable), said
    for row, branch in zip(rows, unstable):
        assert f"{branch['worst_frequency_Hz']:.2f} Hz; unstable" in row, row
        assert "nodal diameter" in row and "friction feeds" in row and "damping ratio -" in row, row


def check_page(page, unstable):
    table = content_of(page.read_text())["unstable_modes"]
    listed = [branch for branch in table["branches"] if branch["unstable"]]
    assert len(listed) == len(unstable), table["summary"]
    for branch, other in zip(listed, unstable):
        assert abs(branch["friction_work"] - other["friction_work"]) < 1e-3 * abs(other["friction_work"]), branch
        assert branch["diameters"] == other["nodal_diameters"], branch


def check_drawing(chromium, page, unstable):
    """Each unstable mode has its label in the Campbell diagram, and no two labels meet."""
    draw(chromium, page, ["campbell", "modes-of-squeal", "rotation", "limit-cycle"])
    shown = browse(chromium, page, "--dump-dom").stdout
    section = re.search(r'<section id="modes-of-squeal">(.*?)</section>', shown, re.DOTALL)[1]
    assert section.count("<tr>") == len(unstable) + 1, section[:500]
    assert "gain from friction" in section
    campbell, growth = re.findall(r"<svg.*?</svg>", section, re.DOTALL)
    for drawing in (campbell, growth):
        labels = re.findall(r'<text[^>]* y="([0-9.]+)" class="label">([^<]+)<', drawing)
        heights = sorted(float(y) for y, _ in labels)
        assert all(b - a >= 10 for a, b in zip(heights, heights[1:])), heights
    labels = re.findall(r'class="label">([^<]+)<', campbell)
    assert len(labels) >= len(unstable), labels
    for branch in unstable:
        shape = f"({branch['nodal_diameters']}, {branch['nodal_circles']})"
        assert any(re.fullmatch(rf"\d+ {re.escape(shape)}", label) for label in labels), (labels, shape)


def main(programs, chromium=None):
    with tempfile.TemporaryDirectory() as name:
        scene = Path(name) / "scene.toml"
        text = (DATA / "coarse_disc.toml").read_text()
        scene.write_text(changed(text, *FINE) + BRAKE)
        run(programs / "chladni", "run", scene, "--output", name)
        said = run(programs / "squeal", "run", scene, "--output", name, "--json", Path(name) / "found.json")
        found = json.loads((Path(name) / "found.json").read_text())
        unstable = check_json(found)
        check_branch(found)
        check_direct(found, said)
        check_terminal(said, unstable)
        run(programs / "squeal", "report", scene, "--output", name)
        page = next(Path(name).glob("*.report.html"))
        check_page(page, unstable)
        if chromium:
            check_drawing(chromium, page, unstable)
    print(f"{len(unstable)} unstable modes are told of everywhere")


if __name__ == "__main__":
    main(Path(sys.argv[1]), *sys.argv[2:])
