"""What the programs show in a terminal while they work, and nothing where nobody wants to read.

Usage: terminal.py BIN_DIR

On a terminal of its own each long command draws one bar whose percentage never falls, also while a tolerance goes through the
same phase again and again, and wipes it out. With --quiet nothing is printed and the files are the same. The completion of
bash finds an option, and every subcommand is in the manual page.
"""

import json
import os
import pty
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from running import changed, run
from stale_files import DISC, LOADED

BAR = re.compile(r"\r\x1b\[K\[([#-]{20})\] +(\d+) %  ([^\r]*)")

SQUEALING = """analyses = ["eigenvalues", "critical-speed", "transient", "limit-cycle"]
transient = { speed_rad_s = 18.85, duration_s = 0.5, initial_pad_displacement = 1e-9 }
"""


def on_terminal(*command):
    """What a program writes to stderr where that is a terminal."""
    own, its = pty.openpty()
    process = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=its)
    os.close(its)
    text = b""
    while True:
        try:
            piece = os.read(own, 4096)
        except OSError:  # the program has closed it
            break
        if not piece:
            break
        text += piece
    if process.wait() != 0:
        sys.exit(f"FAILED: {command} ends with {process.returncode}\n{text.decode()}")
    return text.decode()


def fail(why, text):
    sys.exit(f"FAILED: {why}\n{text!r}")


def check_bar(program, command, scene, folder, expected):
    text = on_terminal(program, command, scene, "--output", folder)
    bars = BAR.findall(text)
    percent = [int(bar[1]) for bar in bars]
    phases = {bar[2].split(",")[0] for bar in bars}
    if not expected <= phases:
        fail(f"{program.name} {command}: phases {phases}", text)
    if percent != sorted(percent) or percent[-1] < 90:
        fail(f"the bar shows {percent}", text)
    if any(bar[0].count("#") != int(20 * p / 100) for bar, p in zip(bars, percent)):
        fail("a bar is not as long as its percentage", text)
    if not text.endswith("\r\x1b[K"):
        fail("the bar stays", text[-200:])
    print(f"ok      {program.name} {command}: one bar from {percent[0]} to {percent[-1]} %, {len(bars)} times")


def check_quiet(chladni, scene, folder):
    silent = run(chladni, "run", scene, "--output", folder, "--quiet")
    if silent or not (folder / "disc.body.h5").exists():
        fail("--quiet prints", silent)
    if on_terminal(chladni, "run", scene, "--output", folder, "--quiet"):
        fail("--quiet shows progress", "")
    summary = json.loads(run(chladni, "body", scene, "--output", folder, "--quiet", "--json", "/dev/stdout"))
    if summary["program"] != "chladni":
        fail("--quiet hides the summary", summary)
    done = subprocess.run([chladni, "run", scene, "--output", "/proc/nowhere", "--quiet"], capture_output=True, text=True)
    if done.returncode != 1 or done.stdout or "/proc/nowhere" not in done.stderr:
        fail("--quiet hides an error", done.stdout + done.stderr)
    print("ok      --quiet prints nothing but errors")


def completed(program, *words):
    """What bash offers for the last of the words."""
    script = f"""source <({program} completion bash); COMP_WORDS=({program.name} {" ".join(words)})
COMP_CWORD={len(words)}; _{program.name}; echo "${{COMPREPLY[@]}}" """
    return run("bash", "-c", script).split()


def check_description(program):
    if completed(program, "ru") != ["run"] or completed(program, "run", "scene.toml", "--ou") != ["--output"]:
        fail("bash does not complete", completed(program, "run", "scene.toml", "--ou"))
    help_text = run(program, "--help")
    page = run(program, "manual")
    zsh, fish = (run(program, "completion", shell) for shell in ("zsh", "fish"))
    for name in re.findall(r"^  ([a-z-]+) {2,}", help_text.split("Subcommands:")[1], re.M):
        if f".SS {program.name} {name}\n" not in page.replace("\\-", "-"):
            fail(f"{name} is not in the manual page", page)
        if f"'{name}:" not in zsh or f"-a {name} " not in fish:
            fail(f"zsh or fish do not know {name}", zsh + fish)
    print(f"ok      {program.name}: completion and manual page")


if __name__ == "__main__":
    programs = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scene = folder / "scene.toml"
        scene.write_text(changed(DISC, ("modes = 10", "tolerance = 1e-3\nup_to_Hz = 4000.0")) + LOADED)
        chladni, squeal = programs / "chladni", programs / "squeal"
        check_bar(chladni, "run", scene, folder, {"mesh", "fixed-interface modes", "choice of modes"})
        whole = scene.read_text()
        # The note of what was found stands in a line of its own.
        scene.write_text(changed(DISC, ("[mesh]\n", '[mesh]\nsectors = "auto"\npattern = "structured"\n')))
        check_bar(chladni, "reduce", scene, folder, {"mesh", "modes of harmonics", "harmonics", "pictures"})
        scene.write_text(whole)
        check_bar(chladni, "modes", scene, folder, {"mesh", "assembly", "modes"})
        check_bar(chladni, "static", scene, folder, {"mesh", "assembly", "solution"})
        scene.write_text(changed(scene.read_text(), ('analyses = ["eigenvalues"]', SQUEALING)))
        check_bar(squeal, "run", scene, folder, {"eigenvalues", "transient", "limit-cycle"})
        check_quiet(programs / "chladni", scene, folder)
        check_description(programs / "chladni")
        check_description(programs / "squeal")
