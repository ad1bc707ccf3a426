"""What a newcomer sees: a fresh clone, the commands of README.md under "Run it", and nothing else.

Usage: newcomer.py OUTPUT.md. Called by `./dev newcomer`.
"""

import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
SHOWN = 14  # last lines of each output


def shell(command, folder, environment):
    start = time.monotonic()
    run = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, text=True,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT)  # fmt: skip
    return run.returncode, run.stdout, time.monotonic() - start


def commands():
    """The indented lines of the section, each without its remark."""
    section = (ROOT / "README.md").read_text().split("## Run it")[1].split("\n## ")[0]
    before_install = section.split("To install:")[0]
    return [line.strip().split("    #")[0].rstrip() for line in re.findall(r"^    (\S.*)$", before_install, re.M)]


def facts():
    model = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text())
    memory = re.search(r"MemTotal:\s*(\d+)", Path("/proc/meminfo").read_text())
    compiler = subprocess.run(["g++", "--version"], capture_output=True, text=True).stdout.splitlines()
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout
    return [f"- machine: {model[1] if model else 'unknown'}, {os.cpu_count()} cores, {int(memory[1]) / 2**20:.0f} GiB",
            f"- load before: {os.getloadavg()[0]:.1f} processes besides", f"- {compiler[0] if compiler else 'no compiler yet'}",
            f"- commit {commit.strip()}, {time.strftime('%Y-%m-%d')}"]  # fmt: skip


def main(output):
    report = ["# A newcomer's log", "",
              "Written by `./dev newcomer`: a fresh clone, then the commands of the README one by one, without compiler cache. Of "
              "each the last lines that it prints.", "", *facts(), ""]  # fmt: skip
    with tempfile.TemporaryDirectory() as name:
        environment = {**os.environ, "CCACHE_DISABLE": "1"}
        first = f"git clone --quiet {ROOT} chladni"
        code, printed, seconds = shell(first, name, environment)
        total = seconds
        clone = Path(name) / "chladni"
        for command in commands():
            if command.startswith("export PATH="):
                environment["PATH"] = f"{clone}/build/release/bin:{environment['PATH']}"
                report += [f"    $ {command}", ""]
                continue
            code, printed, seconds = shell(command, clone, environment)
            total += seconds
            lines = [line.rstrip().replace(name, "") for line in printed.strip().splitlines()][-SHOWN:]
            report += [f"## `{command}`", "", f"{seconds:.0f} s, exit code {code}", "", "```text", *lines, "```", ""]
            print(f"{seconds:8.1f} s  {code}  {command}", flush=True)
            if code:
                break
    report[4:4] = [""]
    report.insert(len(report) if code else 4, f"All commands ended well, after {total / 60:.0f} minutes in all." if not code
                  else f"The last command failed with exit code {code}.")  # fmt: skip
    Path(output).write_text("\n".join(report).rstrip() + "\n")
    sys.exit(code)


if __name__ == "__main__":
    main(sys.argv[1])
