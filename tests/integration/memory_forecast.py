"""The memory that a reduction says it needs, against what it takes.

Usage: memory_forecast.py CHLADNI SOURCE_DIR

Of a scene that is refused for its memory, what it says that it has and that it needs more must be within 10 % of
the largest memory of the same scene when it runs. Where a tolerance finds out how many modes there are to be, what is
said at first is the least that it takes, and the memory is asked about again before the search goes on.
"""

import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from running import changed

OFF = 0.1

# Few masters and a fine mesh: matrices, and what their ordering takes, count for more than Psi.
PLATE = """
name = "plate"
[mesh]
generator = "rectangle"
length = 0.6
width = 0.6
element_order = 3
element_size = 0.015
[material.steel]
young = 2.1e11
poisson = 0.3
density = 7850.0
[[section]]
group = "plate"
type = "shell"
material = "steel"
thickness = 0.006
[interface]
nodes = ["corners"]
[reduce]
method = "craig-bampton"
modes = 50
"""


def memory_MiB(process):
    """The most so far; None when it has ended. """
    found = re.search(r"VmHWM:\s+(\d+)", Path(f"/proc/{process.pid}/status").read_text())
    return int(found[1]) / 1024 if found else None


def watched(*command):
    """The most memory that a program had, and what it prints."""
    process = subprocess.Popen(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    most = 0.0
    while process.poll() is None:
        most = memory_MiB(process) or most
        time.sleep(0.001)
    return most, process.stdout.read()


def check(chladni, text, what, folder):
    scene = folder / "scene.toml"
    scene.write_text(text)
    command = (chladni, "reduce", scene, "--output", folder)
    _, words = watched(*command, "--", "-cms_memory", 10)
    needs = re.search(r"need (?:at least )?(\d+) MiB on one machine besides up to (\d+) MiB", words)
    if not needs:
        sys.exit(f"FAILED: not refused\n{words}")
    by_then = float(needs[2])
    forecast = by_then + float(needs[1])
    most, _ = watched(*command)
    print(f"{what}: {by_then:.0f} MiB and {needs[1]} MiB more; it took {most:.0f} MiB")
    if abs(forecast / most - 1.0) > OFF:
        sys.exit(f"FAILED: {forecast:.0f} MiB forecast")


def refusal(chladni, scene, folder, memory):
    """What a reduction has that is refused for its memory, what it needs, MiB, and how many modes were to be tried."""
    _, words = watched(chladni, "reduce", scene, "--output", folder, "--", "-cms_memory", memory)
    at_first = re.search(r"need at least (\d+) MiB on one machine besides up to (\d+) MiB", words)
    later = re.search(r"search goes on to (\d+) modes; .* they need (\d+) MiB", words)
    if at_first:
        return float(at_first[2]), float(at_first[1]), None
    if later:
        return None, float(later[2]), int(later[1])
    if "wrote " not in words:
        sys.exit(f"FAILED: another error\n{words}")
    return None


def check_growth(chladni, text, what, folder):
    """With ever more memory the search goes on until it ends, and then the forecast was what it takes."""
    scene = folder / "scene.toml"
    scene.write_text(text)
    asked = []
    memory = 10.0
    while refused := refusal(chladni, scene, folder, memory):
        _, needed, n_modes = refused
        if asked and needed <= asked[-1][1]:
            sys.exit(f"FAILED: {needed:.0f} MiB are asked after {asked[-1][1]:.0f}")
        asked.append(refused)
        memory = needed + 1.0
    most, _ = watched(chladni, "reduce", scene, "--output", folder)
    forecast = asked[0][0] + asked[-1][1]
    print(f"{what}: {asked[0][0]:.0f} MiB and then {[needed for _, needed, _ in asked]} more; it took {most:.0f} MiB")
    if asked[0][2] is not None or len(asked) < 2:
        sys.exit("FAILED: the search does not ask for memory again")
    if abs(forecast / most - 1.0) > OFF:
        sys.exit(f"FAILED: {forecast:.0f} MiB forecast")


if __name__ == "__main__":
    chladni, source = sys.argv[1], Path(sys.argv[2])
    disc = changed((source / "examples" / "thesis_disc" / "scene.toml").read_text(), ("element_size = 0.009", "element_size = 0.011"))
    uncounted = re.sub(r"sylvester = true.*", "sylvester = false", disc)
    with tempfile.TemporaryDirectory() as folder:
        check(chladni, disc, "100 modes, counted", Path(folder))
        check(chladni, changed(uncounted, ("modes = 100\n", "modes = 20\n")), "20 modes", Path(folder))
        tolerance = ("modes = 100\n", "tolerance = 1e-4\nup_to_Hz = 4000.0\n")
        check_growth(chladni, changed(uncounted, tolerance), "tolerance", Path(folder))
        free = (('method = "craig-bampton"\n', ""), ("modes = 100\n", "tolerance = 1e-3\nup_to_Hz = 8000.0\n"))
        check(chladni, changed(uncounted, *free), "modes of free masters", Path(folder))
        kept = ("keep = { modes = 40 }", "keep = { tolerance = 1e-3, up_to_Hz = 8000.0 }")
        check(chladni, changed(uncounted, *free, kept), "and responses", Path(folder))
        check(chladni, changed(uncounted, ("craig-bampton", "guyan"), ("modes = 100\n", "")), "Guyan", Path(folder))
        check(chladni, PLATE, "plate, 50 modes", Path(folder))
        check(chladni, changed(PLATE, ("modes = 50\n", "modes = 180\n")), "plate, 180 modes", Path(folder))
        cut_off = (("modes = 50\n", "cutoff_Hz = 4000.0\n"), ("element_size = 0.015", "element_size = 0.02"))
        check_growth(chladni, changed(PLATE, *cut_off), "plate, cut-off", Path(folder))
