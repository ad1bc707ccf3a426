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


# The program of the page takes K and M as given: here a chain of 100 masses with a spring to the ground at each end. Its ends
# are the masters; when both move by 1, so does all between, and the two springs resist.
PROGRAM = """
#include <slepc.h>
%s
int main(int argc, char **argv)
{
  Mat K, M;
  IS masters;
  PetscInt ends[] = {0, 99};

  PetscCall(SlepcInitialize(&argc, &argv, NULL, NULL));
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, 100, 100, 3, NULL, 2, NULL, &K));
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, 100, 100, 1, NULL, 0, NULL, &M));
  for (PetscInt i = 0; i < 100; i++) {
    PetscCall(MatSetValue(K, i, i, 2.0, ADD_VALUES));
    PetscCall(MatSetValue(M, i, i, 1.0, ADD_VALUES));
    if (i > 0) PetscCall(MatSetValue(K, i, i - 1, -1.0, ADD_VALUES));
    if (i < 99) PetscCall(MatSetValue(K, i, i + 1, -1.0, ADD_VALUES));
  }
  PetscCall(MatAssemblyBegin(K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyBegin(M, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(M, MAT_FINAL_ASSEMBLY));
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, 2, ends, PETSC_COPY_VALUES, &masters));
%s
  PetscCall(SlepcFinalize());
}
"""
LOOK = """
  PetscInt rows, first[] = {0, 1};
  PetscScalar k[4];
  PetscCall(MatGetSize(Kr, &rows, NULL));
  PetscCall(MatGetValues(Kr, 2, first, 2, first, k));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%d coordinates, stiffness of the ends %.10f\\n", (int)rows, (double)PetscRealPart(k[0] + k[1] + k[2] + k[3])));
"""
PRINTED = "52 coordinates, stiffness of the ends 2.0000000000"


def blocks(kind):
    return re.findall(rf"^```{kind}\n(.*?)^```$", PAGE.read_text(), re.M | re.S)


def program():
    """The page's piece of C as a program that prints PRINTED."""
    piece = next(block for block in blocks("c") if "CMSCreate" in block)
    include, calls = piece.split("\n\n", 1)
    return PROGRAM % (include, calls.replace("CMSDestroy", LOOK + "CMSDestroy"))


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
