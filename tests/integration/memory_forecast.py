"""The memory that a reduction says it needs, against what it takes.

Usage: memory_forecast.py CHLADNI SOURCE_DIR

Of a scene that is refused for its memory, what it has by then and what it says that it needs more must be within 10 % of
the largest memory of the same scene when it runs.
"""

import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from running import changed

OFF = 0.1


def memory_MiB(process):
    """Resident now, and the most so far; None when it has ended."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    found = [re.search(rf"{name}:\s+(\d+)", status) for name in ("VmRSS", "VmHWM")]
    return [int(match[1]) / 1024 for match in found] if all(found) else None


def watched(*command):
    """What a program has shortly before its end, the most that it had, and what it prints."""
    process = subprocess.Popen(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    last = (0.0, 0.0)
    while process.poll() is None:
        last = memory_MiB(process) or last
        time.sleep(0.001)
    return *last, process.stdout.read()


def check(chladni, text, what, folder):
    scene = folder / "scene.toml"
    scene.write_text(text)
    command = (chladni, "reduce", scene, "--output", folder)
    by_then, _, words = watched(*command, "--", "-cms_memory", 10)
    needs = re.search(r"need (\d+) MiB", words)
    if not needs:
        sys.exit(f"FAILED: not refused\n{words}")
    forecast = by_then + float(needs[1])
    _, most, _ = watched(*command)
    print(f"{what}: {by_then:.0f} MiB and {needs[1]} MiB more; it took {most:.0f} MiB")
    if abs(forecast / most - 1.0) > OFF:
        sys.exit(f"FAILED: {forecast:.0f} MiB forecast")


if __name__ == "__main__":
    chladni, source = sys.argv[1], Path(sys.argv[2])
    disc = (source / "examples" / "thesis_disc" / "scene.toml").read_text()
    uncounted = re.sub(r"sylvester = true.*", "sylvester = false", disc)
    with tempfile.TemporaryDirectory() as folder:
        check(chladni, disc, "100 modes, counted", Path(folder))
        check(chladni, changed(uncounted, ("modes = 100\n", "modes = 20\n")), "20 modes", Path(folder))
        check(chladni, changed(uncounted, ("craig-bampton", "guyan"), ("modes = 100\n", "")), "Guyan", Path(folder))
