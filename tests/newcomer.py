"""What a newcomer sees: a fresh clone, the commands of docs/tutorial/first_run.md, and nothing else: no compiler cache, and
none of the settings that ./dev makes for itself. What is installed goes to a folder that is removed again.

Usage: newcomer.py OUTPUT.md. Called by `./dev newcomer`.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests/tools"))
from compile_times import machine, processor_seconds, table  # noqa: E402
SHOWN = 14  # last lines of each output
OF_DEV = re.compile(r"OMPI_|OPENBLAS_|OMP_|CCACHE_|PYTHONDONTWRITEBYTECODE")


def shell(command, folder, environment):
    """(exit code, what it prints, seconds on the clock, seconds of processors)"""
    start, used = time.monotonic(), processor_seconds()
    run = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, text=True,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT)  # fmt: skip
    return run.returncode, run.stdout, time.monotonic() - start, processor_seconds() - used


def commands():
    """The indented lines of the page, each without its remark."""
    page = (ROOT / "docs/tutorial/first_run.md").read_text()
    return [line.strip().split("    #")[0].rstrip() for line in re.findall(r"^    (\S.*)$", page, re.M)]


def exported(command, folder, environment):
    """The environment after an `export`."""
    after = subprocess.run(["bash", "-c", command + "; env -0"], cwd=folder, env=environment, capture_output=True, check=True)
    return dict(entry.split("=", 1) for entry in after.stdout.decode().split("\0") if entry)


def facts(load):
    """Of the machine as it is now, with the load that it had before."""
    model = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text())
    compiler = subprocess.run("g++ --version", shell=True, capture_output=True, text=True).stdout.splitlines()
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout
    return [f"- machine: {model[1] if model else 'unknown'}, {machine()}",
            f"- load before: {load:.1f} processes besides", f"- {compiler[0] if compiler else 'no compiler yet'}",
            f"- commit {commit.strip()}, {time.strftime('%Y-%m-%d')}"]  # fmt: skip


def main(output):
    report = ["# A newcomer's log", "",
              "Written by `./dev newcomer`: a fresh clone, then the commands of docs/tutorial/first_run.md one by one, without compiler cache. Of "
              "each the last lines that it prints.", ""]  # fmt: skip
    load, missing = os.getloadavg()[0], not shutil.which("g++")
    with tempfile.TemporaryDirectory() as name:
        kept = {key: value for key, value in os.environ.items() if not OF_DEV.match(key)}
        environment = {**kept, "CCACHE_DISABLE": "1"}
        first = f"git clone --quiet {ROOT} chladni"
        code, printed, total, _ = shell(first, name, environment)
        clone = Path(name) / "chladni"
        for command in commands():
            if command.startswith("export "):
                environment = exported(command, clone, environment)
                report += [f"    $ {command}", ""]
                continue
            elsewhere = {"DESTDIR": f"{name}/installed"} if command.startswith("cmake --install") else {}
            code, printed, seconds, used = shell(command, clone, {**environment, **elsewhere})
            total += seconds
            lines = [line.rstrip().replace(name, "") for line in printed.strip().splitlines()][-SHOWN:]
            report += [f"## `{command}`", "", f"{seconds:.0f} s, of processors {used:.0f} s, exit code {code}", "", "```text", *lines, "```", ""]
            print(f"{seconds:8.1f} s  {code}  {command}", flush=True)
            if command.startswith("./dev demo"):
                report += ["Of this, compiling, by the clock of each step:", "", *table(clone / "build/release"), ""]
            if code:
                break
    outcome = f"The last command failed with exit code {code}." if code else (
        f"All commands ended well, after {total / 60:.0f} minutes in all" +
        (", the installation of all packages included." if missing else "."))  # fmt: skip
    report[4:4] = [outcome, "", *facts(load), ""]
    Path(output).write_text("\n".join(report).rstrip() + "\n")
    sys.exit(code)


if __name__ == "__main__":
    main(sys.argv[1])
