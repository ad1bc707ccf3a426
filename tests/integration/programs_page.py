"""docs/reference/programs.md is what the programs say of themselves with --help. Usage: programs_page.py PROGRAM_DIR [--update]"""

import re
import sys
from pathlib import Path

from running import start

PAGE = Path(__file__).parents[2] / "docs/reference/programs.md"
INTRODUCTION = """# Programs

`chladni` needs PETSc and MPI and does everything; `squeal` needs neither and works on body files. Each command below prints the text that
stands there with `--help`. This page is made of these texts: `./dev pages`.

The exit code is 0 if all went well, 1 if an input cannot be used or a computation failed, and 2 for a wrong command line.
"""


def help_of(*command):
    run = start(*command, "--help")
    if run.returncode:
        sys.exit(f"FAILED: {command} --help\n{run.stderr}")
    return "\n".join(line.rstrip() for line in run.stdout.strip().splitlines())


def page(programs):
    lines = [INTRODUCTION]
    for program in ("chladni", "squeal"):
        overview = help_of(programs / program)
        lines += [f"## `{program}`", "", "```text", overview, "```", ""]
        for command in re.findall(r"^  ([a-z-]+) {2,}", overview.split("Subcommands:")[1], re.M):
            lines += [f"### `{program} {command}`", "", "```text", help_of(programs / program, command), "```", ""]
    return "\n".join(lines)


def as_any_version(text):
    """CLI11 up to 2.3 writes a default as `DIR=.`, later ones as `DIR [.]`, and both break lines where they are long."""
    return re.sub(r"(?<=[A-Z\]}])=(\S+)", r" [\1]", " ".join(text.split()))


def main(programs, update=False):
    text = page(programs)
    if update:
        PAGE.write_text(text)
    elif as_any_version(PAGE.read_text()) != as_any_version(text):
        sys.exit("FAILED: docs/reference/programs.md is out of date; ./dev pages writes it anew")
    print("ok      docs/reference/programs.md is what the programs say")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), "--update" in sys.argv)
