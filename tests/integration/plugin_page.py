"""docs/how-to/plugin.md lists what the solver type refuses as it says with -help, and its program in C compiles by its command and
runs. Usage: plugin_page.py BUILD_DIR [--update]
"""

import os
import re
import sys
import tempfile
from pathlib import Path

from running import start

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/how-to/plugin.md"
AS_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
HEADING = "### What blocklanczos refuses, and why\n"


def refusals(build):
    """The lines of its table, as -help prints them."""
    command = [build / "examples/laplacian", "-dll_append", build / "lib/libchladni_petsc.so", "-eps_type", "blocklanczos", "-help"]
    run = start(*command, env={**os.environ, **AS_ROOT})
    told = run.stdout.split("blocklanczos refuses:\n")
    if run.returncode or len(told) < 2:
        sys.exit(f"FAILED: {command} tells nothing\n{run.stdout[-2000:]}{run.stderr}")
    return re.match(r"(?:  - .*\n)+", told[1])[0].replace("  - ", "- ")


# The page takes K, M and masters as given: those of the example membrane here, 12 x 12 points of which an edge is kept.
PROGRAM = """
#define main main_of_the_example
#include "%s/examples/plugin/membrane.c"
#undef main
%s
int main(int argc, char **argv)
{
  Mat K, M;
  IS masters;
  PetscInt rows, columns;

  PetscCall(SlepcInitialize(&argc, &argv, NULL, NULL));
  PetscCall(create_membrane(12, &K, &M));
  PetscCall(ISCreateStride(PETSC_COMM_SELF, 12, 0, 1, &masters));
%s
  PetscCall(SlepcFinalize());
}
"""
LOOK = """PetscCall(MatGetSize(T, &rows, &columns));
PetscCall(PetscPrintf(PETSC_COMM_SELF, "%d rows, %d coordinates\\n", (int)rows, (int)columns));
"""
PRINTED = "144 rows, 62 coordinates"


def blocks(kind):
    return re.findall(rf"^```{kind}\n(.*?)^```$", PAGE.read_text(), re.M | re.S)


def program():
    """The page's piece of C as a program that prints PRINTED."""
    piece = next(block for block in blocks("c") if "CMSCreate" in block)
    include, calls = piece.split("\n\n", 1)
    return PROGRAM % (ROOT, include, calls.replace("CMSDestroy", LOOK + "CMSDestroy"))


def runs(folder, command, environment):
    """Whether the command of the page compiles reduce.c in a folder to a program that prints what is right."""
    (folder / "reduce.c").write_text(program())
    for words in (["sh", "-ec", command], [folder / "reduce"]):
        done = start(*words, cwd=folder, env={**os.environ, **AS_ROOT, **environment})
        if done.returncode:
            sys.exit(f"FAILED: {command}\n{done.stdout}{done.stderr}")
    if PRINTED not in done.stdout:
        sys.exit(f"FAILED: the program of the page prints {done.stdout!r}, not {PRINTED!r}")
    print(f"ok      {command.strip().splitlines()[-1].strip()}")


def compile_in_the_tree(build):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "build").mkdir()
        (folder / "build/release").symlink_to(build)
        (folder / "plugin").symlink_to(ROOT / "plugin")
        runs(folder, next(block for block in blocks("sh") if "-Iplugin" in block), {})


def main(build, update=False):
    before, section = PAGE.read_text().split(HEADING)
    introduction, listed, after = re.fullmatch(r"(.*?)((?:- .*\n)*)(\n##.*)", section, re.S).groups()
    told = refusals(build)
    if update:
        PAGE.write_text(before + HEADING + introduction.rstrip() + "\n\n" + told + after)
    elif listed != told:
        sys.exit("FAILED: docs/how-to/plugin.md is out of date; ./dev pages writes it anew")
    print(f"ok      docs/how-to/plugin.md lists the {told.count(chr(10))} refusals of blocklanczos")
    compile_in_the_tree(build)


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), "--update" in sys.argv)
