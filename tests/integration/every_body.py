"""Bodies as people have them, all modes, through `squeal run`: with frequency response modes, of a tolerance, with vanes, and
with a hat on five bolts.

Usage: every_body.py PROGRAM_DIR
"""

import json
import re
import sys
import tempfile
from pathlib import Path

from pair_between_planes import critical_speeds
from report import content_of
from running import changed, run, start

DATA = Path(__file__).parents[1] / "data"
HAT = Path(__file__).parents[2] / "examples/hat_disc"
BRAKE = """
[squeal]
ring = "track"
thickness = 0.02
speeds = { from_rad_s = 3.0, to_rad_s = 60.0, count = 4 }
friction = 0.6
pads = [{ angle_deg = 0.0, stiffness = 6e6, damping = 0.0, preload = 2000.0 }]
"""
AXISYMMETRIC = 'analyses = ["eigenvalues", "critical-speed", "growth", "transient", "limit-cycle-direct"]\n' \
    'growth = { speeds_rad_s = [18.85], duration_s = 0.5 }\n' \
    'transient = { speed_rad_s = 18.85, duration_s = 0.2, initial_pad_displacement = 1e-6 }\n' \
    'limit_cycle_direct = { speed_rad_s = 40.0 }\n'
ANY = 'analyses = ["rotation-stability", "growth"]\ngrowth = { speeds_rad_s = [30.0], duration_s = 0.3 }\n'
FINE = (("element_size = 0.03", "element_size = 0.02"), ("nodes = 12", "nodes = 24"), ("modes = 20", "modes = 60"))


def studies(programs, scenes, look=lambda folder: None):
    """What `squeal run` finds for each of some scenes that differ in [squeal] alone, and what it says: the body is made
    once. `look` sees the files."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        file, json_file = folder / "scene.toml", folder / "summary.json"
        for part in (*DATA.glob("*.geo"), HAT / "hat_disc.geo"):
            (folder / part.name).write_text(part.read_text())
        found = []
        for scene in scenes:
            file.write_text(scene)
            if not found:
                run(programs / "chladni", "run", file, "--output", name)
            said = run(programs / "squeal", "run", file, "--output", name, "--json", json_file)
            found.append((json.loads(json_file.read_text()), said))
        look(folder)
        return found


def squeal(programs, scene, look=lambda folder: None):
    """The same of one scene."""
    return studies(programs, [scene], look)[0]


def check_symmetric(programs):
    """Response modes do in few modes what many do; a body of a tolerance is as good. Even many modes lack the compliance
    of those beyond them, so the best body has both."""
    plain = (DATA / "coarse_disc.toml").read_text() + BRAKE + AXISYMMETRIC
    keep = "keep = { modes = 30 }"
    responses = 'interface_modes = [{ kind = "frm", at = "track", dofs = ["z"], omega0 = "auto" }]\n'
    few = changed(plain, *FINE, (keep, "keep = { up_to_Hz = 3000.0 }"))
    with_responses = ("damping = {", responses + "damping = {")
    many, _ = squeal(programs, changed(plain, *FINE, (keep, "keep = { up_to_Hz = 9000.0 }"), with_responses))
    poor, _ = squeal(programs, few)
    augmented, said = squeal(programs, changed(few, with_responses))
    assert "follow the pads without inertia" in said, said
    tolerant = changed(plain, FINE[0], FINE[1], ("modes = 20", "tolerance = 1e-3\nup_to_Hz = 3000.0"),
                       (keep, "keep = { tolerance = 1e-3, up_to_Hz = 3000.0 }"))
    chosen, said = squeal(programs, tolerant)
    assert "follow the pads without inertia" in said, said
    best = many["critical_speed_rad_s"]
    off = {name: abs(found["critical_speed_rad_s"] / best - 1)
           for name, found in (("few", poor), ("augmented", augmented), ("tolerance", chosen))}
    print("critical speed", best, "off by", off)
    assert off["augmented"] < 0.3 * off["few"] and off["tolerance"] < 0.3 * off["few"], off
    for found in (augmented, chosen):
        assert found["failure"] is None and not found["missing"], found["failure"]
        assert found["limit_cycle_direct"]["frequency_Hz"] > 100.0, found["limit_cycle_direct"]


def check_contact_planes(programs):
    """Each friction ring of a ventilated disc under its own pad: rings in the two plates, planes 4 mm from them. A single ring
    takes its slope times half the thickness for the motion of the planes along themselves. Here the hub holds one of the
    plates and vanes shear: the planes move along the track by 0.105 and -0.051 where that takes 0.143, and radially by 0.25 and
    0.07 for 0.18, so that the disc squeals at a higher speed. Both speeds are those of forces written down by themselves."""
    ring = 'rings = [{ name = "track", radius = 0.13, nodes = 24, z = 0.012 }'
    scene = changed((DATA / "ventilated_disc.toml").read_text(), ("modes = 20\npictures", "modes = 30\npictures"),
                    (ring, ring + ', { name = "inner", radius = 0.13, nodes = 24, z = -0.012 }'),
                    ('nodes = ["track", "hub"]', 'nodes = ["track", "inner", "hub"]'))
    brake = BRAKE.replace("0.02", "0.032") + 'use_modes = "nodal-diameters 3"\nanalyses = ["critical-speed"]\n'
    faces = changed(brake, ('ring = "track"', 'ring = { inboard = "inner", outboard = "track" }'))
    alone = []
    planes = changed(faces, ("thickness = 0.032", "contact_planes = [-0.016, 0.016]"))
    all_found = studies(programs, [scene + faces, scene + planes, scene + brake], lambda folder: alone.extend(
        critical_speeds(folder / "coarse.body.h5", (("track", 0.004), ("inner", -0.004)), [5, 6], 3, 0.032)))
    found, same, plate = (each["critical_speed_rad_s"] for each, _ in all_found)
    print("critical speed", found, "of two rings,", plate, "of one; by forces of first order", alone)
    assert abs(found / same - 1) < 1e-12, (found, same)
    # Forces of second order in the slopes are in `squeal` alone.
    assert abs(found / alone[0] - 1) < 0.01 and abs(plate / alone[1] - 1) < 0.01, (found, plate, alone)
    assert found > 1.1 * plate, (found, plate)


def check_others(programs):
    """Vanes mix harmonics."""
    vanes = changed((DATA / "ventilated_disc.toml").read_text(), ("modes = 20\npictures", "modes = 30\npictures"))
    found, _ = squeal(programs, vanes + BRAKE.replace("0.02", "0.032") + ANY)
    assert found["failure"] is None and not found["missing"], found["failure"]
    # Twelve vanes split the pairs of six nodal diameters, and others: by Hill's method.
    split = changed(vanes, ('file = "ventilated_disc.geo"', 'file = "ventilated_disc.geo"\nparameters = { n_vanes = 12 }'))
    found, said = squeal(programs, split + BRAKE.replace("0.02", "0.032").replace("3.0", "20.0") +
                         'analyses = ["critical-speed", "stability"]\n')  # fmt: skip
    assert found["failure"] is None and not found["missing"], found["failure"]
    table = found["stability_table"]
    assert (table["method"], found["critical_speed_method"]) == ("hill", "hill") and "Hill" in said, found
    assert 0.0 < table["error_1_s"] < 1e-3, table["error_1_s"]
    unstable = sorted(limits[0] for branch in table["branches"] for limits in branch["unstable"])
    assert unstable and abs(found["unstable_speeds_rad_s"][0][0] - unstable[0]) < 1e-9, (unstable, found)
    grows = [max(branch["growth_1_s"]) > table["error_1_s"] for branch in table["branches"]]
    assert sum(grows) <= sum(bool(branch["unstable"]) for branch in table["branches"]), grows


def check_nodes_that_vanes_turn(programs):
    """A vane turns the node of a ring that stands on it, so that the slopes of a mode of 24 diameters at three nodes a vane look
    like those of 96: such a disc is not refused for its 72 nodes."""
    ring = changed((DATA / "ventilated_disc.toml").read_text(), ("element_order = 2", "element_order = 3"),
                   ("nodes = 24", "nodes = 72"), ("keep = { modes = 20 }", "keep = { modes = 10 }"))
    found, _ = squeal(programs, ring + BRAKE.replace("0.02", "0.032") + 'analyses = ["rotation-stability"]\n')
    assert found["failure"] is None, found["failure"]


def check_bolts(programs):
    """The hat disc of the examples, held at the edges of five holes for bolts, so that it is not axisymmetric. A transient
    grows as Hill's method says, and ends in a motion that the turning disc modulates."""
    shipped = (HAT / "scene.toml").read_text()
    scene = changed(shipped, ("size = 16.0 }", "size = 16.0, n_bolts = 5 }"), ('group = "hub_edge"', 'group = "bolts"'),
                    ("element_order = 3", "element_order = 2"), ("modes = 60", "modes = 40"),
                    ("keep = { modes = 40 }", "keep = { modes = 30 }"),
                    ("speeds = { from_rad_s = 5.0, to_rad_s = 30.0, count = 6 }",
                     "speeds = { from_rad_s = 20.0, to_rad_s = 30.0, count = 2 }"),
                    ('analyses = ["rotation-stability"]',
                     'analyses = ["rotation-stability", "growth", "motion-statistics", "limit-cycle"]\n'
                     'growth = { speeds_rad_s = [30.0], duration_s = 2.0 }\n'
                     'transient = { speed_rad_s = 30.0, duration_s = 2.5, initial_pad_displacement = 1e-4 }'))
    pages = []

    def page(folder):
        run(programs / "squeal", "report", folder / "scene.toml", "--output", folder)
        pages.append(content_of(next(folder.glob("*.report.html")).read_text()))

    found, said = squeal(programs, scene, page)
    assert found["failure"] is None and not found["missing"], found["failure"]
    assert "take no part: 6" in said and "last 4 rotations" in said, said
    assert '"motion-statistics" shows how it squeals' in " ".join(said.split()), said  # where a limit cycle was asked for
    growth = found["growth"][0]["measured_growth_1_s"]
    hill = found["rotation_stability"]["growth"][-1]["growth_1_s"]
    # Two more motions grow half as fast: e^4 is between them and the first after two seconds.
    print("five bolts: growth", growth, "in a transient,", hill, "by Hill's method")
    assert hill > 1.0 and abs(growth / hill - 1) < 0.1, (growth, hill)
    motion = found["motion_statistics"]
    assert motion["n_rotations"] == 4 and 0.0 < motion["rms_velocity_m_s"] < motion["peak_velocity_m_s"], motion
    assert motion["lines"] and motion["modulation"] > 0.0, motion
    assert len(pages[0]["statistics"]["rms_over_angle"]) == 24, pages[0]["statistics"]


FEW_NODES = """
name = "few"
[mesh]
generator = "annulus"
inner_radius = 0.04
outer_radius = 0.13
element_size = 0.016
rings = [{ name = "track", radius = 0.105, nodes = 5 }]
[material.iron]
young = 1.2e11
poisson = 0.27
density = 7200.0
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = 0.012
[[coupling]]
type = "rigid"
name = "hub"
group = "inner_edge"
[interface]
nodes = ["track", "hub"]
[reduce]
method = "mixed-interface"
modes = 60
[body]
fixed = ["hub"]
keep = { up_to_Hz = 8500.0 }
[squeal]
ring = "track"
thickness = 0.012
speeds = { from_rad_s = 2.0, to_rad_s = 60.0, count = 6 }
friction = 0.45
contact = "unilateral"
pads = [{ angle_deg = 10.0, stiffness = 5e6, damping = 0.0, preload = 1500.0 }]
analyses = ["eigenvalues", "critical-speed"]
"""


def check_few_nodes(programs):
    """A ring whose nodes cannot tell the diameters of the modes is refused, with a number of nodes that suffices."""
    with tempfile.TemporaryDirectory() as name:
        file = Path(name) / "scene.toml"
        file.write_text(FEW_NODES)
        run(programs / "chladni", "run", file, "--output", name)
        refused = start(programs / "squeal", "run", file, "--output", name)
        assert refused.returncode == 1 and "5 nodes" in refused.stderr, refused.stderr
        enough = int(re.search(r"give the ring (\d+) nodes", refused.stderr)[1])
    print("ring of 5 nodes: refused,", enough, "suffice")
    assert 12 <= enough <= 24, enough
    for nodes in (enough, 24, 36):
        found, _ = squeal(programs, changed(FEW_NODES, ("nodes = 5 ", f"nodes = {nodes} ")))
        speed = found["critical_speed_rad_s"]
        print("ring of", nodes, "nodes: critical speed", speed, "rad/s")
        assert abs(speed / 6.683 - 1) < 5e-4, speed  # meshes differ with the ring


def growing(found, up_to_Hz):
    """Frequency and largest growth of the modes that grow below a frequency."""
    return sorted((branch["worst_frequency_Hz"], branch["worst_growth_1_s"])
                  for branch in found["stability_table"]["branches"]
                  if branch["worst_growth_1_s"] > 0.0 and branch["worst_frequency_Hz"] < up_to_Hz)


def check_default_body(programs):
    """A body without `keep` has all that its reduction has, most of it far above the range. What it tells below half of the
    range is what a body of the range tells."""
    keep = "keep = { tolerance = 1e-4, up_to_Hz = 6000.0 }\n"
    scene = changed(FEW_NODES, ("nodes = 5 ", "nodes = 36 "), ("keep = { up_to_Hz = 8500.0 }\n", keep),
                    ('method = "mixed-interface"\nmodes = 60', "tolerance = 1e-4\nup_to_Hz = 6000.0"),
                    ('"critical-speed"]', '"critical-speed", "stability"]'))
    (chosen, _), (whole, said) = squeal(programs, scene), squeal(programs, changed(scene, (keep, "")))
    assert "follow the pads without inertia" in said, said
    off = abs(whole["critical_speed_rad_s"] / chosen["critical_speed_rad_s"] - 1)
    rows = list(zip(growing(chosen, 3000.0), growing(whole, 3000.0), strict=True))
    print("default body: critical speed off by", off, "growth", rows)
    assert off < 5e-3 and len(rows) > 1, (off, rows)
    for (f, growth), (f_whole, growth_whole) in rows:
        assert abs(f_whole / f - 1) < 1e-4 and abs(growth_whole / growth - 1) < 5e-3, rows


if __name__ == "__main__":
    check_default_body(Path(sys.argv[1]))
    check_few_nodes(Path(sys.argv[1]))
    check_symmetric(Path(sys.argv[1]))
    check_contact_planes(Path(sys.argv[1]))
    check_others(Path(sys.argv[1]))
    check_nodes_that_vanes_turn(Path(sys.argv[1]))
    check_bolts(Path(sys.argv[1]))
    print("every body is taken")
