"""docs/how-to/plugin.md lists what the solver type refuses as it says with -help. Usage: plugin_page.py BUILD_DIR [--update]"""

import os
import re
import sys
from pathlib import Path

from running import start

PAGE = Path(__file__).parents[2] / "docs/how-to/plugin.md"
HEADING = "### What blocklanczos refuses, and why\n"


def refusals(build):
    """The lines of its table, as -help prints them."""
    command = [build / "examples/laplacian", "-dll_append", build / "lib/libchladni_petsc.so", "-eps_type", "blocklanczos", "-help"]
    run = start(*command, env={**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"})
    told = run.stdout.split("blocklanczos refuses:\n")
    if run.returncode or len(told) < 2:
        sys.exit(f"FAILED: {command} tells nothing\n{run.stdout[-2000:]}{run.stderr}")
    return re.match(r"(?:  - .*\n)+", told[1])[0].replace("  - ", "- ")


def main(build, update=False):
    before, section = PAGE.read_text().split(HEADING)
    introduction, listed, after = re.fullmatch(r"(.*?)((?:- .*\n)*)(\n##.*)", section, re.S).groups()
    told = refusals(build)
    if update:
        PAGE.write_text(before + HEADING + introduction.rstrip() + "\n\n" + told + after)
    elif listed != told:
        sys.exit("FAILED: docs/how-to/plugin.md is out of date; ./dev pages writes it anew")
    print(f"ok      docs/how-to/plugin.md lists the {told.count(chr(10))} refusals of blocklanczos")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), "--update" in sys.argv)
